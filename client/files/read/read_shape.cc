#include "client/files/read/read_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <new>
#include <utility>

#include "base/number_text.h"
#include "client/base/error.h"
#include "client/files/format.h"
#include "client/files/read/read_file.h"
#include "client/files/read/shape_parsers.h"
#include "core/base/error.h"
#include "core/mesh/polygon_cut.h"
#include "core/mesh/quad_diagonals.h"

namespace affskel::client {
namespace {

ShapeFile parse_off(std::string_view bytes) {
  ShapeFile file;
  file.off = core::read_off(bytes);
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

Parser parser_for(const std::string& path, std::string_view bytes) {
  const std::string extension = lower_extension(path);
  for (const auto& [name, parser] : kParsers) {
    if (extension == name) return parser;
  }
  if (bytes.starts_with("ply")) return parse_ply;
  if (bytes.starts_with("OFF")) return parse_off;
  throw ClientError(ExitCode::kBadInput,
                    "not a known kind of file; points are read from .csv .ply .off .xyz .vtp .dat, "
                    "surfaces from .off .ply .obj .stl .vtp",
                    path);
}

void check_finite(const ShapeFile& file) {
  for (const PointColumn& column : file.columns) {
    if (!is_normal_column(column.name)) continue;
    for (std::size_t i = 0; i < column.values.size(); ++i) {
      if (!std::isfinite(column.values[i])) {
        throw core::CoreError(core::CoreError::Code::kBadInput,
                              "point " + std::to_string(i) + ": " + column.name + " is not finite");
      }
    }
  }
}

}  // namespace

ShapeFile read_shape(const std::string& path) {
  return parse_shape(path, read_file(path));
}

ShapeFile parse_shape(const std::string& path, std::string_view bytes) {
  const Parser parser = parser_for(path, bytes);
  try {
    ShapeFile file = parser(bytes);
    core::turn_doubled_diagonals(file.quads, file.off.mesh.triangles);
    check_finite(file);
    file.path = path;
    return file;
  } catch (const core::CoreError& error) {
    throw error_from_core(error, path);
  } catch (const std::bad_alloc&) {
    throw out_of_memory(path);
  }
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
  core::Mesh& mesh = file.off.mesh;
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
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    fail_at(line, place + " uses a vertex twice");
  }
  if (indices.size() == 4) file.quads.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
  core::cut_polygon(mesh.points, indices, mesh.triangles);
}

void fail_at(std::uint64_t line, const std::string& message) {
  const std::string where = line > 0 ? "line " + std::to_string(line) + ": " : std::string();
  throw core::CoreError(core::CoreError::Code::kBadInput, where + message, line);
}

}  // namespace affskel::client
