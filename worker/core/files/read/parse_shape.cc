#include "core/files/read/parse_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/files/read/other_kinds.h"
#include "core/files/read/shape_parsers.h"
#include "core/files/read/voxel_parsers.h"
#include "core/mesh/polygon_cut.h"
#include "core/mesh/quad_diagonals.h"
#include "core/text/text_rows.h"
#include "core/voxels/isosurface.h"

namespace affskel::core {
namespace {

ShapeFile parse_off(std::string_view bytes) {
  if (is_binary_off(bytes)) return parse_binary_off(bytes);
  ShapeFile file;
  file.off = read_off(bytes);
  return file;
}

using Parser = ShapeFile (*)(std::string_view);

constexpr std::array<std::pair<std::string_view, Parser>, 11> kParsers = {{{".csv", parse_csv},
                                                                           {".dat", parse_dat},
                                                                           {".xyz", parse_xyz},
                                                                           {".off", parse_off},
                                                                           {".ply", parse_ply},
                                                                           {".obj", parse_obj},
                                                                           {".stl", parse_stl},
                                                                           {".vtp", parse_vtp},
                                                                           {".glb", parse_gltf},
                                                                           {".gltf", parse_gltf},
                                                                           {".3mf", parse_3mf}}};

Parser parser_for(std::string_view extension) {
  for (const auto& [name, parser] : kParsers) {
    if (extension == name) return parser;
  }
  throw CoreError(CoreError::Code::kBadInput,
                  "not a known kind of file; points are read from .csv .ply .off .xyz .vtp .dat, "
                  "surfaces from .off .ply .obj .stl .vtp .glb .gltf .3mf");
}

// Whether a column of this name belongs to a normal: nx or nx_SUFFIX, or a component of an array normal, normals, Normal or
// Normals, with _a or _b behind it or not (Normals_x, normal_a_x); the same of y and z.
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

std::uint32_t known_vertex(const Mesh& mesh, std::int64_t vertex, const std::string& place,
                           std::uint64_t line) {
  const auto known = static_cast<std::int64_t>(mesh.points.size());
  if (vertex < 0 || vertex >= known)
    fail_at(line,
            place + " uses a vertex that does not exist (" + std::to_string(known) + " vertices are known)");
  return static_cast<std::uint32_t>(vertex);
}

bool holds_mesh(std::string_view extension) {
  const auto is_it = [&](const auto& known) { return known.first == extension; };
  return extension != ".dat" && std::any_of(kParsers.begin(), kParsers.end(), is_it);
}

// The extension that the content stands for; empty where it says nothing, as of rows of numbers.
std::string_view told_extension(std::string_view bytes) {
  // First, for its 80 bytes of header may say anything.
  if (is_binary_stl(bytes)) return ".stl";
  if (bytes.starts_with("ply")) return ".ply";
  if (bytes.starts_with("glTF")) return ".glb";
  if (bytes.starts_with("PK\x03\x04")) return ".3mf";
  const std::string_view word = first_word(bytes);
  if (word == "solid") return ".stl";
  if (word.ends_with("OFF")) return ".off";
  if (word.starts_with("<?xml") || word.starts_with("<VTKFile") || word.starts_with("<!--")) return ".vtp";
  if (word.starts_with('{')) return ".gltf";
  constexpr std::array<std::string_view, 12> kObjWords = {"v",      "vn",     "vt", "vp", "f", "l",
                                                          "mtllib", "usemtl", "o",  "g",  "s", "p"};
  return std::find(kObjWords.begin(), kObjWords.end(), word) != kObjWords.end() ? ".obj" : "";
}

MeshFile mesh_of_voxels(std::string_view bytes, const MeshFileOptions& options) {
  const VoxelImage image = parse_voxels(bytes, options.beside);
  if (!options.isovalue) {
    const auto [least, greatest] = value_range(image);
    throw CoreError(
        CoreError::Code::kBadInput,
        "is an image of " + std::to_string(image.size[0]) + " x " + std::to_string(image.size[1]) + " x " +
            std::to_string(image.size[2]) + " voxels with values from " + base::rounded(least, 6) + " to " +
            base::rounded(greatest, 6) + "; the isovalue, which they have at the surface, must be given");
  }
  Isosurface surface = isosurface(image, {.isovalue = *options.isovalue, .context = options.context});
  MeshFile file{"voxels", false, {}, {}};
  file.told = "the surface at " + base::to_text(*options.isovalue) + " of " +
              std::to_string(image.numbers.size()) + " voxels, sought in cubes of " +
              base::rounded(surface.resolution, 3) + " voxels; the solid is where values are " +
              (surface.below ? "below" : "above");
  file.off.mesh = std::move(surface.mesh);
  file.off.polygons = file.off.mesh.triangles.size();
  return file;
}

}  // namespace

ShapeFile parse_shape(std::string_view extension, std::string_view bytes) {
  refuse_other_kinds(bytes);
  const std::string_view told = told_extension(bytes);
  ShapeFile file = parser_for(told.empty() ? extension : told)(bytes);
  turn_doubled_diagonals(file.quads, file.off.mesh.triangles);
  check_finite(file);
  return file;
}

MeshFile parse_mesh_file(std::string_view extension, std::string_view bytes, const MeshFileOptions& options) {
  if (bytes.empty() && extension != ".off") fail_at(0, "the file is empty");
  if (is_voxel_image(bytes)) return mesh_of_voxels(bytes, options);
  if (options.isovalue)
    throw CoreError(CoreError::Code::kBadInput,
                    "is no image of voxels (NRRD, MetaImage, NIfTI-1), which an isovalue is for");
  refuse_other_kinds(bytes);
  const std::string_view told = told_extension(bytes);
  const std::string_view kind = !told.empty() ? told : holds_mesh(extension) ? extension : ".off";
  if (kind == ".off" && !is_binary_off(bytes)) {
    if (extension != ".off") refuse_unknown_kinds(bytes);
    return {"off", true, read_off(bytes), {}};
  }
  ShapeFile shape = parse_shape(kind, bytes);
  if (!shape.segments.empty()) shape.off.passed_over.push_back({"curves", shape.segments.size(), 0});
  return {kind == ".off" ? "binary off" : std::string(kind.substr(1)), false, std::move(shape.off), {}};
}

void add_polygon(ShapeFile& file, const std::vector<std::int64_t>& corners, const std::string& place,
                 std::uint64_t line) {
  Mesh& mesh = file.off.mesh;
  if (corners.size() < 3) {
    fail_at(line, place + " has " + base::counted(corners.size(), "corner") + ", needs 3");
  }
  std::vector<std::uint32_t> indices;
  for (const std::int64_t corner : corners) indices.push_back(known_vertex(mesh, corner, place, line));
  std::vector<std::uint32_t> sorted = indices;
  std::sort(sorted.begin(), sorted.end());
  if (indices.size() > 3 && std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    fail_at(line, place + " uses a vertex twice");
  }
  if (indices.size() == 4) file.quads.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
  if (indices.size() > 3) count_cut(file.off, indices, line);
  cut_polygon(mesh.points, indices, mesh.triangles);
}

void add_polyline(ShapeFile& file, const std::vector<std::int64_t>& vertices, const std::string& place,
                  std::uint64_t line) {
  if (vertices.size() < 2)
    fail_at(line, place + " has " + base::counted(vertices.size(), "vertex", "vertices") + ", needs 2");
  std::uint32_t before = known_vertex(file.mesh(), vertices[0], place, line);
  for (const std::int64_t vertex : vertices) {
    const std::uint32_t at = known_vertex(file.mesh(), vertex, place, line);
    if (at != before) file.segments.push_back({before, at});
    before = at;
  }
}

}  // namespace affskel::core
