#include "core/files/read/parse_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/files/file_format.h"
#include "core/files/read/other_kinds.h"
#include "core/files/read/shape_parsers.h"
#include "core/mesh/polygon_cut.h"
#include "core/mesh/quad_diagonals.h"

namespace affskel::core {
namespace {

ShapeFile parse_off(std::string_view bytes) {
  ShapeFile file;
  file.off = read_off(bytes);
  return file;
}

using Parser = ShapeFile (*)(std::string_view);

constexpr std::array<std::pair<std::string_view, Parser>, 8> kParsers = {{{".csv", parse_csv},
                                                                          {".dat", parse_dat},
                                                                          {".xyz", parse_xyz},
                                                                          {".off", parse_off},
                                                                          {".ply", parse_ply},
                                                                          {".obj", parse_obj},
                                                                          {".stl", parse_stl},
                                                                          {".vtp", parse_vtp}}};

Parser parser_for(std::string_view extension, std::string_view bytes) {
  for (const auto& [name, parser] : kParsers) {
    if (extension == name) return parser;
  }
  if (bytes.starts_with("ply")) return parse_ply;
  if (bytes.starts_with("OFF")) return parse_off;
  throw CoreError(CoreError::Code::kBadInput,
                  "not a known kind of file; points are read from .csv .ply .off .xyz .vtp .dat, "
                  "surfaces from .off .ply .obj .stl .vtp");
}

void check_finite(const ShapeFile& file) {
  for (const PointColumn& column : file.columns) {
    if (!is_normal_column(column.name)) continue;
    for (std::size_t i = 0; i < column.values.size(); ++i) {
      if (!std::isfinite(column.values[i])) {
        throw CoreError(CoreError::Code::kBadInput,
                        "point " + std::to_string(i) + ": " + column.name + " is not finite");
      }
    }
  }
}

// Of a file that holds a mesh: by the extension; PLY also by the first bytes of a file without a known one.
FileFormat mesh_format(std::string_view extension, std::string_view bytes) {
  for (const FileFormat format : {FileFormat::kPly, FileFormat::kObj, FileFormat::kStl, FileFormat::kVtp}) {
    if (extension == extension_of(format)) return format;
  }
  return extension != extension_of(FileFormat::kOff) && bytes.starts_with("ply") ? FileFormat::kPly
                                                                                 : FileFormat::kOff;
}

// Of the first line that is neither blank nor a comment.
std::string_view first_word(std::string_view bytes) {
  constexpr std::string_view kBlank = " \t\r\n\v\f";
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  while (true) {
    bytes.remove_prefix(std::min(bytes.find_first_not_of(kBlank), bytes.size()));
    if (!bytes.starts_with('#')) return bytes.substr(0, bytes.find_first_of(kBlank));
    bytes.remove_prefix(std::min(bytes.find('\n'), bytes.size()));
  }
}

}  // namespace

ShapeFile parse_shape(std::string_view extension, std::string_view bytes) {
  refuse_other_kinds(bytes);
  ShapeFile file = parser_for(extension, bytes)(bytes);
  turn_doubled_diagonals(file.quads, file.off.mesh.triangles);
  check_finite(file);
  return file;
}

MeshFile parse_mesh_file(std::string_view extension, std::string_view bytes) {
  refuse_other_kinds(bytes);
  const FileFormat format = mesh_format(extension, bytes);
  if (format == FileFormat::kOff) return {format, read_off(bytes)};
  ShapeFile shape = parse_shape(extension, bytes);
  if (shape.mesh().triangles.empty())
    throw CoreError(CoreError::Code::kBadInput, "has no triangles; a mesh that bounds a solid is wanted");
  if (!shape.segments.empty()) shape.off.passed_over.push_back({"curves", shape.segments.size(), 0});
  return {format, std::move(shape.off)};
}

std::string_view extension_of_content(std::string_view bytes) {
  // First, for its 80 bytes of header may say anything.
  if (is_binary_stl(bytes)) return ".stl";
  if (bytes.starts_with("ply")) return ".ply";
  if (bytes.starts_with("solid")) return ".stl";
  const std::string_view word = first_word(bytes);
  if (word.starts_with("<?xml") || word.starts_with("<VTKFile") || word.starts_with("<!--")) return ".vtp";
  constexpr std::array<std::string_view, 12> kObjWords = {"v",      "vn",     "vt", "vp", "f", "l",
                                                          "mtllib", "usemtl", "o",  "g",  "s", "p"};
  return std::find(kObjWords.begin(), kObjWords.end(), word) != kObjWords.end() ? ".obj" : ".off";
}

bool is_normal_column(std::string_view name) {
  const auto take = [&name](std::string_view start) {
    const bool found = name.starts_with(start);
    if (found) name.remove_prefix(start.size());
    return found;
  };
  const auto is_axis = [](char c) { return c == 'x' || c == 'y' || c == 'z'; };
  if (take("normal") || take("Normal")) {
    take("s");
    if (!take("_a")) take("_b");
    return name.size() == 2 && name[0] == '_' && is_axis(name[1]);
  }
  return name.size() >= 2 && name[0] == 'n' && is_axis(name[1]) && (name.size() == 2 || name[2] == '_');
}

void add_polygon(ShapeFile& file, const std::vector<std::int64_t>& corners, const std::string& place,
                 std::uint64_t line) {
  Mesh& mesh = file.off.mesh;
  if (corners.size() < 3) {
    fail_at(line, place + " has " + base::counted(corners.size(), "corner") + ", needs 3");
  }
  std::vector<std::uint32_t> indices;
  for (const std::int64_t corner : corners) {
    if (corner < 0 || static_cast<std::uint64_t>(corner) >= mesh.points.size()) {
      fail_at(line, place + " uses a vertex that does not exist (" + std::to_string(mesh.points.size()) +
                        " vertices are known)");
    }
    indices.push_back(static_cast<std::uint32_t>(corner));
  }
  std::vector<std::uint32_t> sorted = indices;
  std::sort(sorted.begin(), sorted.end());
  if (indices.size() > 3 && std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    fail_at(line, place + " uses a vertex twice");
  }
  if (indices.size() == 4) file.quads.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
  cut_polygon(mesh.points, indices, mesh.triangles);
}

void add_polyline(ShapeFile& file, const std::vector<std::int64_t>& vertices, const std::string& place,
                  std::uint64_t line) {
  if (vertices.size() < 2)
    fail_at(line, place + " has " + base::counted(vertices.size(), "vertex", "vertices") + ", needs 2");
  const auto known = static_cast<std::int64_t>(file.mesh().points.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i] < 0 || vertices[i] >= known) {
      fail_at(line, place + " uses a vertex that does not exist (" + std::to_string(known) +
                        " vertices are known)");
    }
    if (i == 0 || vertices[i] == vertices[i - 1]) continue;
    file.segments.push_back(
        {static_cast<std::uint32_t>(vertices[i - 1]), static_cast<std::uint32_t>(vertices[i])});
  }
}

void fail_at(std::uint64_t line, const std::string& message) {
  const std::string where = line > 0 ? "line " + std::to_string(line) + ": " : std::string();
  throw CoreError(CoreError::Code::kBadInput, where + message, line);
}

}  // namespace affskel::core
