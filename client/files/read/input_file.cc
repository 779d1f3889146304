#include "client/files/read/input_file.h"

#include <algorithm>
#include <array>
#include <new>
#include <string_view>
#include <utility>

#include "base/number_text.h"
#include "client/base/error.h"
#include "client/files/format.h"
#include "client/files/read/read_file.h"
#include "core/files/read/parse_shape.h"
#include "core/files/read/unpack.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

// What rows of OBJ hold beside a mesh.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kMeanings = {
    {{"vn", "normals"},
     {"vt", "texture coordinates"},
     {"vp", "parameters"},
     {"mtllib", "materials"},
     {"usemtl", "materials"},
     {"o", "names of objects"},
     {"g", "groups"},
     {"s", "smoothing"},
     {"p", "points"}}};

// The server stores OFF text: what the file holds beside its surface (colours, normals) has no place there.
void parse(InputFile& input, std::string_view extension, const core::MeshFileOptions& options) {
  input.packed = core::compression_of(input.bytes);
  if (!input.packed.empty()) input.bytes = core::unpack(input.bytes);
  core::MeshFile file = core::parse_mesh_file(extension, input.bytes, options);
  input.format = std::move(file.format);
  input.off_text = file.off_text;
  input.told = std::move(file.told);
  input.off = std::move(file.off);
  if (!input.off_text) input.bytes = std::string();
}

InputFile parsed_input(const std::string& path, std::string bytes, const std::string& extension,
                       const core::MeshFileOptions& options) {
  InputFile input;
  input.path = path;
  input.bytes = std::move(bytes);
  input.file_bytes = input.bytes.size();
  input.file_sha256 = wire::sha256_hex(input.bytes);
  try {
    parse(input, extension, options);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, path);
  } catch (const std::bad_alloc&) {
    throw out_of_memory(path);
  }
  return input;
}

}  // namespace

core::OffMesh parse_mesh(const std::string& bytes, const std::string& path) {
  try {
    return core::read_off(bytes);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, path);
  } catch (const std::bad_alloc&) {
    throw out_of_memory(path);
  }
}

InputFile read_input(const std::string& path, const core::MeshFileOptions& options) {
  return parsed_input(path, read_file(path), lower_extension(core::unpacked_name(path)), options);
}

InputFile read_named_input(const std::string& name, const core::MeshFileOptions& options) {
  if (name != "-") {
    core::MeshFileOptions with_files = options;
    with_files.beside = [&name](const std::string& other) {
      return read_file((std::filesystem::path(name).parent_path() / other).string());
    };
    return read_input(name, with_files);
  }
  return parsed_input("stdin", read_standard_input("stdin"), "", options);
}

std::string job_name(const std::filesystem::path& file) {
  return std::filesystem::path(core::unpacked_name(file.native())).stem().string();
}

std::string passed_over_text(const core::OffMesh& off) {
  std::string text;
  for (const core::PassedOver& one : off.passed_over) {
    const auto known = std::find_if(kMeanings.begin(), kMeanings.end(),
                                    [&](const auto& meaning) { return meaning.first == one.word; });
    const std::string meaning = known == kMeanings.end() ? "" : " (" + std::string(known->second) + ")";
    text += (text.empty() ? "" : ", ") + base::counted(one.rows, one.each) + " of " + one.word + meaning;
  }
  return text;
}

Notices conversion_notices(const InputFile& input) {
  Notices notices;
  if (const std::string text = passed_over_text(input.off); !text.empty())
    notices.push_back(note("PASSED_OVER", "passed over " + text, input.path));
  if (!input.packed.empty()) {
    notices.push_back(note("UNPACKED", "unpacked by " + input.packed, input.path));
  }
  if (!input.told.empty()) notices.push_back(note("ISOSURFACE", input.told, input.path));
  if (!input.off.unit.empty())
    notices.push_back(note("UNIT", "lengths are in the file's unit, the " + input.off.unit, input.path));
  if (!input.off_text) {
    notices.push_back(note("CONVERTED",
                           "read as " + input.format + ", " + std::to_string(input.off.mesh.points.size()) +
                               " vertices and " + std::to_string(input.off.mesh.triangles.size()) +
                               " triangles; what is sent is OFF text, which fetch mesh gives",
                           input.path));
  }
  return notices;
}

core::Solid check_solid(const InputFile& input, bool repair, core::ExecutionContext* context) {
  core::SolidOptions options;
  options.repair = repair;
  options.context = context;
  try {
    return core::make_solid(input.off.mesh, options, input.off.vertex_line, input.off.triangle_line);
  } catch (const core::CoreError& error) {
    throw error_from_core(error, input.path);
  }
}

std::string uneven_text(const core::OffMesh& off, double volume) {
  constexpr double kTold = 1e-4;  // of the volume
  const double share = off.uneven_volume / volume;
  if (!(share > kTold)) return "";
  const std::string place = off.uneven_line > 0 ? " (line " + std::to_string(off.uneven_line) + ")" : "";
  return "faces of more than three sides are not plane, the worst by " +
         base::rounded(off.uneven_distance, 3) + place +
         "; cut otherwise, they would change the volume by up to " + base::rounded(100 * share, 2) + " %";
}

Notices solid_notices(const core::Solid& solid, const InputFile& input) {
  Notices notices;
  if (const std::string text = uneven_text(input.off, solid.volume); !text.empty())
    notices.push_back(warning("UNEVEN_POLYGONS", text, input.path));
  for (const core::MeshNote& found : solid.notes) {
    const bool repaired = found.severity == core::MeshNote::Severity::kRepaired;
    notices.push_back(repaired ? note(found.code, "repaired: " + found.message, input.path)
                               : warning(found.code, found.message, input.path));
  }
  return notices;
}

}  // namespace affskel::client
