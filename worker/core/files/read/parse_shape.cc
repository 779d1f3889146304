#include "core/files/read/parse_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "base/quoted.h"
#include "core/base/error.h"
#include "core/files/read/shape_parsers.h"
#include "core/mesh/quad_diagonals.h"
#include "core/text/text_rows.h"
#include "core/voxels/isosurface.h"

namespace affskel::core {
namespace {

using namespace std::string_view_literals;

ShapeFile parse_off(std::string_view bytes) {
  if (is_binary_off(bytes)) return parse_binary_off(bytes);
  ShapeFile file;
  file.off = read_off(bytes);
  return file;
}

using Parser = ShapeFile (*)(std::string_view);

// What a kind of file holds.
constexpr unsigned kPoints = 1, kSurface = 2, kCloud = 4;  // a cloud: points that may be those of a surface

struct Kind {
  std::string_view extension;
  Parser parse;
  unsigned holds;
};

constexpr std::array<Kind, 11> kKinds = {{{".xyz", parse_xyz, kPoints | kCloud},
                                          {".csv", parse_csv, kPoints | kCloud},
                                          {".dat", parse_dat, kPoints},
                                          {".off", parse_off, kPoints | kSurface},
                                          {".ply", parse_ply, kPoints | kSurface},
                                          {".obj", parse_obj, kSurface},
                                          {".stl", parse_stl, kSurface},
                                          {".vtp", parse_vtp, kPoints | kSurface},
                                          {".glb", parse_gltf, kSurface},
                                          {".gltf", parse_gltf, kSurface},
                                          {".3mf", parse_3mf, kSurface}}};

std::vector<std::string_view> extensions_of(unsigned what) {
  std::vector<std::string_view> extensions;
  for (const Kind& kind : kKinds)
    if ((kind.holds & what) != 0) extensions.push_back(kind.extension);
  return extensions;
}

bool holds_mesh(std::string_view extension) {
  const auto known = extensions_of(kSurface | kCloud);
  return std::find(known.begin(), known.end(), extension) != known.end();
}

Parser parser_for(std::string_view extension) {
  for (const Kind& kind : kKinds)
    if (extension == kind.extension) return kind.parse;
  refuse("not a known kind of file; points are read from" + listed(extensions_of(kPoints)) +
         ", surfaces from" + listed(mesh_extensions()));
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
        refuse("point " + std::to_string(i) + ": " + column.name + " is not finite");
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

// Refuses what neither its content nor its name tells to be of a kind that is read, unless it may be OFF text.
void refuse_unknown_kinds(std::string_view bytes) {
  const bool binary = bytes.substr(0, kSeen).find('\0') != std::string_view::npos;
  if (!binary && may_be_off(bytes)) return;
  const std::string_view word = bytes.substr(0, bytes.find_first_of(" \t\r\n"));
  refuse(
      (binary
           ? "is binary, of no kind that is read"
           : "is of no kind that is read, and begins with " + base::quoted(std::string(word.substr(0, 30)))) +
      "; read are OFF, PLY, OBJ, STL, VTP, glTF, 3MF, points as .xyz and .csv, of voxels NRRD, MetaImage and "
      "NIfTI, and any of these packed by gzip or zstd");
}

// Refuses files that are known by their first bytes and cannot be read, with what they are and what to do.
void refuse_other_kinds(std::string_view bytes) {
  if (is_binary_stl(bytes)) return;  // its header may say anything
  if (bytes.substr(0, kSeen).find("<COLLADA") != std::string_view::npos)
    refuse("is COLLADA, and not read" + std::string(kExport));
  for (const OtherKind& kind : kOthers) {
    if (bytes.starts_with(kind.begins))
      refuse("is " + std::string(kind.is) + ", and not read" + std::string(kind.advice));
  }
}

// The extension that the content stands for; empty where it says nothing, as of rows of numbers.
std::string_view told_extension(std::string_view bytes) {
  // First, for its 80 bytes of header may say anything.
  if (is_binary_stl(bytes)) return ".stl";
  if (bytes.starts_with("ply")) return ".ply";
  if (bytes.starts_with("glTF")) return ".glb";
  if (bytes.starts_with("PK\x03\x04")) return ".3mf";
  const std::string_view word = first_word(bytes);
  if (is_text_stl(bytes)) return ".stl";
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
    const std::string what = "is an image of " + std::to_string(image.size[0]) + " x " +
                             std::to_string(image.size[1]) + " x " + std::to_string(image.size[2]) +
                             " voxels";
    refuse(least == greatest
               ? what + " that all have the value " + base::rounded(least, 6) + ": there is no surface"
               : what + " with values from " + base::rounded(least, 6) + " to " + base::rounded(greatest, 6) +
                     "; the isovalue, which they have at the surface, must be given");
  }
  Isosurface surface = isosurface(image, {.isovalue = *options.isovalue, .context = options.context});
  MeshFile file{"voxels", false, {}, {}};
  file.told = "the surface at " + base::to_text(*options.isovalue) + " of " +
              std::to_string(image.numbers.size()) + " voxels, sought in cubes of " +
              base::rounded(surface.resolution, 3) + " voxels; the solid is where values are " +
              (surface.below ? "below" : "above") +
              (surface.cut ? "; it reaches the image's border, and is closed there" : "");
  file.off.mesh = std::move(surface.mesh);
  file.off.polygons = file.off.mesh.triangles.size();
  return file;
}

}  // namespace

void check_counts(std::uint64_t points, std::uint64_t triangles) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 28;
  if (points > kMost || triangles > kMost)
    throw CoreError(CoreError::Code::kLimit, "has " + std::to_string(points) + " vertices and " +
                                                 std::to_string(triangles) + " triangles; more than " +
                                                 std::to_string(kMost) + " of either are not read");
}

std::vector<std::string_view> mesh_extensions() {
  return extensions_of(kSurface);
}

std::vector<std::string_view> cloud_extensions() {
  return extensions_of(kCloud);
}

std::vector<std::string_view> voxel_extensions(VoxelFiles which) {
  if (which == VoxelFiles::kWhole) return {".nrrd", ".mha", ".nii"};
  return {".nrrd", ".nhdr", ".mha", ".mhd", ".nii"};
}

std::vector<std::string_view> packed_extensions() {
  return {".gz", ".zst"};
}

std::string listed(const std::vector<std::string_view>& extensions) {
  std::string text;
  for (const std::string_view extension : extensions) text += " " + std::string(extension);
  return text;
}

ShapeFile parse_shape(std::string_view extension, std::string_view bytes) {
  refuse_other_kinds(bytes);
  const std::string_view told = told_extension(bytes);
  ShapeFile file = parser_for(told.empty() ? extension : told)(bytes);
  check_counts(file.mesh().points.size(), file.mesh().triangles.size());
  turn_doubled_diagonals(file.quads, file.off.mesh.triangles);
  check_finite(file);
  return file;
}

MeshFile parse_mesh_file(std::string_view extension, std::string_view bytes, const MeshFileOptions& options) {
  if (bytes.empty() && extension != ".off") fail_at(0, "the file is empty");
  if (is_voxel_image(bytes)) return mesh_of_voxels(bytes, options);
  if (options.isovalue) refuse("is no image of voxels (NRRD, MetaImage, NIfTI-1), which an isovalue is for");
  refuse_other_kinds(bytes);
  const std::string_view told = told_extension(bytes);
  const std::string_view kind = !told.empty() ? told : holds_mesh(extension) ? extension : ".off";
  if (kind == ".off" && !is_binary_off(bytes)) {
    if (extension != ".off") refuse_unknown_kinds(bytes);
    MeshFile file{"off", true, read_off(bytes), {}};
    check_counts(file.off.mesh.points.size(), file.off.mesh.triangles.size());
    return file;
  }
  ShapeFile shape = parse_shape(kind, bytes);
  if (!shape.segments.empty()) shape.off.passed_over.push_back({"curves", shape.segments.size(), 0});
  return {kind == ".off" ? "binary off" : std::string(kind.substr(1)), false, std::move(shape.off), {}};
}

void add_polygon(ShapeFile& file, const std::vector<std::int64_t>& corners, const std::string& place,
                 std::uint64_t line) {
  if (corners.size() < 3) {
    fail_at(line, place + " has " + base::counted(corners.size(), "corner") + ", needs 3");
  }
  std::vector<std::uint32_t> indices;
  for (const std::int64_t corner : corners) indices.push_back(known_vertex(file.mesh(), corner, place, line));
  if (add_polygon(file.off, indices, line, file.quads)) fail_at(line, place + " uses a vertex twice");
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
