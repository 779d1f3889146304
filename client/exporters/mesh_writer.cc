#include "client/exporters/mesh_writer.h"

#include <limits>
#include <string_view>

#include "affskel/v1/types.pb.h"
#include "client/console.h"
#include "client/error.h"
#include "client/exporters/numbers.h"
#include "core/mesh_io.h"

namespace affskel::client {
namespace {

using Write = std::function<void(std::string_view)>;

void write_ply(const core::Mesh& mesh, const std::vector<std::string>& comments, const Write& write) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) text += "comment " + printable(comment) + "\n";
  text += "element vertex " + std::to_string(mesh.points.size()) +
          "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
          std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  write(text);
  for (const core::Vec3& p : mesh.points) {
    text.clear();
    for (int c = 0; c < 3; ++c) append_bytes(text, p[c]);
    write(text);
  }
  for (const core::Triangle& t : mesh.triangles) {
    text.clear();
    append_bytes(text, std::uint8_t{3});
    for (const std::uint32_t corner : t) append_bytes(text, static_cast<std::int32_t>(corner));
    write(text);
  }
}

void write_obj(const core::Mesh& mesh, const std::vector<std::string>& comments, const Write& write) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + printable(comment) + "\n";
  write(text);
  for (const core::Vec3& p : mesh.points) {
    write("v " + shortest(p.x) + " " + shortest(p.y) + " " + shortest(p.z) + "\n");
  }
  for (const core::Triangle& t : mesh.triangles) {
    text = "f";
    for (const std::uint32_t corner : t) {
      text.push_back(' ');
      append_integer(text, std::uint64_t{corner} + 1);
    }
    write(text + "\n");
  }
}

void write_stl(const core::Mesh& mesh, const Write& write) {
  // A binary header must not begin with "solid", which marks the text variant.
  std::string text = "triangle mesh, units as submitted";
  text.resize(80, ' ');
  append_bytes(text, static_cast<std::uint32_t>(mesh.triangles.size()));
  write(text);
  for (const core::Triangle& t : mesh.triangles) {
    const core::Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    core::Vec3 normal = core::cross(b - a, c - a);
    const double length = core::norm(normal);
    if (length > 0) normal = (1 / length) * normal;
    text.clear();
    for (const core::Vec3& v : {normal, a, b, c}) {
      for (int k = 0; k < 3; ++k) append_bytes(text, static_cast<float>(v[k]));
    }
    append_bytes(text, std::uint16_t{0});
    write(text);
  }
}

}  // namespace

core::Mesh parse_surface(const std::string& bytes) {
  v1::TriangleMesh message;
  if (!message.ParseFromString(bytes) || message.xyz_size() % 3 != 0 || message.corners_size() % 3 != 0) {
    throw ClientError(ExitCode::kInternal, "the server sent a damaged surface");
  }
  core::Mesh mesh;
  for (int i = 0; i < message.xyz_size(); i += 3) {
    mesh.points.push_back({message.xyz(i), message.xyz(i + 1), message.xyz(i + 2)});
  }
  for (int i = 0; i < message.corners_size(); i += 3) {
    const core::Triangle t = {message.corners(i), message.corners(i + 1), message.corners(i + 2)};
    for (const std::uint32_t corner : t) {
      if (corner >= mesh.points.size()) {
        throw ClientError(ExitCode::kInternal, "the server sent a damaged surface: a corner out of range");
      }
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

void write_mesh(FileFormat format, const core::Mesh& mesh, const std::vector<std::string>& comments,
                const Write& write) {
  if (mesh.points.size() > std::size_t{std::numeric_limits<std::int32_t>::max()} ||
      mesh.triangles.size() > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
    throw ClientError(ExitCode::kLimit, "the mesh has too many elements for this format");
  }
  switch (format) {
    case FileFormat::kOff:
      return write(core::write_off(mesh));
    case FileFormat::kPly:
      return write_ply(mesh, comments, write);
    case FileFormat::kObj:
      return write_obj(mesh, comments, write);
    case FileFormat::kStl:
      return write_stl(mesh, write);
    default:
      throw ClientError(ExitCode::kInternal, "no mesh writer for " + std::string(extension_of(format)));
  }
}

}  // namespace affskel::client
