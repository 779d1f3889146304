// Every reader of files: what is read must be a mesh that its own text gives back.
#include <algorithm>
#include <array>
#include <cmath>

#include "bytes.h"
#include "client/files/write/shape_writer.h"
#include "core/base/error.h"
#include "core/files/file_format.h"
#include "core/files/read/parse_shape.h"
#include "core/files/read/unpack.h"
#include "core/shapes/shapes.h"
#include "targets.h"
#include "tools/gzipped.h"
#include "tools/sample_files.h"

namespace affskel::fuzz {
namespace {

constexpr std::array<std::string_view, 14> kExtensions = {".off", ".ply",  ".obj", ".stl", ".vtp",
                                                          ".glb", ".gltf", ".3mf", ".xyz", ".csv",
                                                          ".dat", ".nrrd", ".mha", ".nii"};
constexpr std::size_t kMostTriangles = 20000;  // whose text is read back

void check(const core::OffMesh& off) {
  const core::Mesh& mesh = off.mesh;
  for (const core::Vec3& p : mesh.points)
    if (!std::isfinite(p.x + p.y + p.z) && !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
      throw Finding("a coordinate is not finite");
  for (const core::Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (v >= mesh.points.size()) throw Finding("a triangle names a point that is not there");
  if (mesh.triangles.size() > kMostTriangles) return;
  const core::Mesh again = core::read_off(core::write_off(mesh)).mesh;
  if (again.triangles != mesh.triangles) throw Finding("the text of a mesh has other triangles");
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const core::Vec3 &a = again.points[v], &b = mesh.points[v];
    if (!(a.x == b.x && a.y == b.y && a.z == b.z)) throw Finding("the text of a mesh has other points");
  }
}

void run(std::string_view input) {
  Bytes bytes(input);
  const std::string_view extension = kExtensions[bytes.below(kExtensions.size())];
  core::MeshFileOptions options;
  if (const unsigned value = bytes.below(4); value > 0) options.isovalue = value - 1.5;
  const std::string_view file = bytes.rest();
  try {
    const bool packed = !core::compression_of(file).empty();
    const std::string unpacked = packed ? core::unpack(file) : std::string();
    check(core::parse_mesh_file(extension, packed ? unpacked : file, options).off);
  } catch (const core::CoreError&) {
  }
  try {
    core::parse_shape(extension, file);
  } catch (const core::CoreError&) {
  }
}

// A file as this program writes it.
std::string written(core::FileFormat format, const core::Mesh& mesh) {
  client::ShapeFile shape;
  shape.off.mesh = mesh;
  std::string bytes;
  client::write_surface(format, shape, {"a comment"}, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

std::vector<std::string> seeds() {
  using namespace tests::samples;
  const core::Mesh mesh = core::make_box(1, 2, 3);
  const auto format = [](std::string_view extension) {
    return std::string(1, static_cast<char>(std::ranges::find(kExtensions, extension) - kExtensions.begin()));
  };
  std::vector<std::string> inputs;
  const auto add = [&](std::string_view extension, const std::string& file, char isovalue = 0) {
    inputs.push_back(format(extension) + isovalue + file);
  };
  for (const core::FileFormat kind : core::surface_formats())
    add(core::extension_of(kind), written(kind, mesh));
  add(".off", binary_off(mesh, "COFF", 4));
  add(".off", "4OFF\n4 4 6\n0 0 0 1\n2 0 0 2\n0 1 0 1\n0 0 1 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  add(".obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\ng flat\nf 1//1 2//1 3//1 4//1\nf -4 -2 -3\nl 1 2\n");
  add(".glb", glb(gltf_parts(mesh)));
  add(".gltf", gltf(gltf_parts(mesh, 20)));
  add(".3mf", threemf(object_text(mesh, "1"), "<item objectid=\"1\"/>"));
  add(".xyz", "0 0 0 1 0 0\n1 2 3 0 1 0\n");
  add(".csv", "x,y,z,E\n0,0,0,1\n1,2,3,2.5\n");
  add(".nrrd", nrrd("float", "endian: little\nencoding: raw\n", bytes_of<float>(false)), 2);
  add(".nrrd", nrrd("short", "encoding: gzip\n", tests::gzipped(bytes_of<std::int16_t>(false))), 2);
  add(".mha", metaimage("MET_SHORT", "", bytes_of<std::int16_t>(false)), 2);
  add(".nii", nifti(true, false), 3);
  add(".nii", nifti(false, true), 3);
  add(".off", tests::gzipped(core::write_off(mesh)));
  return inputs;
}

}  // namespace

const Target kMeshFiles = {"mesh_files", seeds, run, 20000};

}  // namespace affskel::fuzz
