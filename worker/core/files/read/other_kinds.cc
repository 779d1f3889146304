#include "core/files/read/other_kinds.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/quoted.h"
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

constexpr std::size_t kSeen = 1024;  // bytes in which a file says what it is

// Whether a text begins as OFF may; of one without words the reader says so.
bool may_be_off(std::string_view text) {
  const std::string_view header = first_word(text);
  return header.empty() || (header.size() <= 8 && header.ends_with("OFF"));
}

}  // namespace

std::string_view first_word(std::string_view bytes) {
  constexpr std::string_view kBlank = " \t\r\n\v\f";
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  while (true) {
    bytes.remove_prefix(std::min(bytes.find_first_not_of(kBlank), bytes.size()));
    if (!bytes.starts_with('#')) return bytes.substr(0, bytes.find_first_of(kBlank));
    bytes.remove_prefix(std::min(bytes.find_first_of("\r\n"), bytes.size()));
  }
}

void refuse_unknown_kinds(std::string_view bytes) {
  const bool binary = bytes.substr(0, kSeen).find('\0') != std::string_view::npos;
  if (!binary && may_be_off(bytes)) return;
  const std::string_view word = bytes.substr(0, bytes.find_first_of(" \t\r\n"));
  throw CoreError(
      CoreError::Code::kBadInput,
      (binary
           ? "is binary, of no kind that is read"
           : "is of no kind that is read, and begins with " + base::quoted(std::string(word.substr(0, 30)))) +
          "; read are OFF, PLY, OBJ, STL, VTP, glTF, 3MF, points as .xyz and .csv, of voxels NRRD, MetaImage and "
          "NIfTI, and any of these packed by gzip or zstd");
}

void refuse_other_kinds(std::string_view bytes) {
  if (is_binary_stl(bytes)) return;  // its header may say anything
  if (bytes.substr(0, kSeen).find("<COLLADA") != std::string_view::npos)
    throw CoreError(CoreError::Code::kBadInput, "is COLLADA, and not read" + std::string(kExport));
  for (const OtherKind& kind : kOthers) {
    if (bytes.starts_with(kind.begins))
      throw CoreError(CoreError::Code::kBadInput,
                      "is " + std::string(kind.is) + ", and not read" + std::string(kind.advice));
  }
}

}  // namespace affskel::core
