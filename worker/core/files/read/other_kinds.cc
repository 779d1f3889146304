#include "core/files/read/other_kinds.h"

#include <array>
#include <string>

#include "core/base/error.h"
#include "core/files/read/shape_parsers.h"

namespace affskel::core {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kExport = "; export its triangles as .off, .ply, .obj, .stl or .glb";

struct OtherKind {
  std::string_view begins, is, advice;
};

constexpr std::array<OtherKind, 11> kOthers = {{
    {"ISO-10303-21"sv, "STEP, which holds exact surfaces", kExport},
    {"Kaydara FBX"sv, "FBX", kExport},
    {"BLENDER"sv, "a scene of Blender", kExport},
    {"#VRML"sv, "VRML", kExport},
    {"\x89HDF\r\n\x1a\n"sv, "HDF5, which holds no mesh here", ""},
    {"\xfd"
     "7zXZ\0"sv,
     "compressed by xz", "; unpack it first, with unxz"},
    {"BZh"sv, "compressed by bzip2", "; unpack it first, with bunzip2"},
    {"7z\xbc\xaf\x27\x1c"sv, "an archive (.7z)", "; unpack it first"},
    {"\x89PNG\r\n"sv, "a picture (.png)", ""},
    {"\xff\xd8\xff"sv, "a picture (.jpg)", ""},
    {"%PDF"sv, "a PDF", ""},
}};

}  // namespace

void refuse_other_kinds(std::string_view bytes) {
  if (is_binary_stl(bytes)) return;  // its header may say anything
  for (const OtherKind& kind : kOthers) {
    if (bytes.starts_with(kind.begins))
      throw CoreError(CoreError::Code::kBadInput,
                      "is " + std::string(kind.is) + ", and not read" + std::string(kind.advice));
  }
}

}  // namespace affskel::core
