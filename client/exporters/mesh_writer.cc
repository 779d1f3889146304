#include "client/exporters/mesh_writer.h"

#include <limits>
#include <string_view>
#include <utility>

#include "client/console.h"
#include "client/error.h"
#include "client/exporters/numbers.h"
#include "client/exporters/single_precision.h"
#include "client/exporters/vtp_writer.h"
#include "core/text/off_file.h"

namespace affskel::client {
namespace {

using Write = std::function<void(std::string_view)>;

void write_ply(const core::Mesh& mesh, const std::vector<std::string>& comments,
               const std::vector<VertexProperty>& properties, const Write& write) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) text += "comment " + one_line(comment) + "\n";
  text += "element vertex " + std::to_string(mesh.points.size()) +
          "\nproperty double x\nproperty double y\nproperty double z\n";
  for (const VertexProperty& property : properties) {
    for (const std::string& name : property.components) text += "property double " + name + "\n";
  }
  text += "element face " + std::to_string(mesh.triangles.size()) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  write(text);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    text.clear();
    for (int c = 0; c < 3; ++c) append_bytes(text, mesh.points[v][c]);
    for (const VertexProperty& property : properties) {
      const std::size_t n = property.components.size();
      for (std::size_t c = 0; c < n; ++c) append_bytes(text, property.values[n * v + c]);
    }
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
  for (const std::string& comment : comments) text += "# " + one_line(comment) + "\n";
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
  check_fits_stl(mesh);
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

// One column per component.
std::vector<PointColumn> columns_of(const std::vector<VertexProperty>& properties, std::size_t vertices) {
  std::vector<PointColumn> columns;
  for (const VertexProperty& property : properties) {
    const std::size_t n = property.components.size();
    for (std::size_t c = 0; c < n; ++c) {
      columns.push_back({property.components[c], false, std::vector<double>(vertices)});
      for (std::size_t v = 0; v < vertices; ++v) columns.back().values[v] = property.values[n * v + c];
    }
  }
  return columns;
}

[[noreturn]] void damaged(const std::string& what) {
  throw ClientError(ExitCode::kInternal, "the server sent a damaged surface: " + what);
}

void add_property(FetchedSurface& surface, std::vector<std::string> components,
                  const google::protobuf::RepeatedField<double>& values) {
  if (values.empty()) return;
  if (static_cast<std::size_t>(values.size()) != components.size() * surface.mesh.points.size()) {
    damaged("a vertex without its properties");
  }
  surface.properties.push_back({std::move(components), {values.begin(), values.end()}});
}

}  // namespace

FetchedSurface parse_surface(const std::string& bytes) {
  v1::TriangleMesh message;
  if (!message.ParseFromString(bytes) || message.xyz_size() % 3 != 0 || message.corners_size() % 3 != 0) {
    damaged("odd numbers");
  }
  FetchedSurface surface;
  for (int i = 0; i < message.xyz_size(); i += 3) {
    surface.mesh.points.push_back({message.xyz(i), message.xyz(i + 1), message.xyz(i + 2)});
  }
  for (int i = 0; i < message.corners_size(); i += 3) {
    const core::Triangle t = {message.corners(i), message.corners(i + 1), message.corners(i + 2)};
    for (const std::uint32_t corner : t) {
      if (corner >= surface.mesh.points.size()) damaged("a corner out of range");
    }
    surface.mesh.triangles.push_back(t);
  }
  add_property(surface, {"E"}, message.erosion());
  add_property(surface, {"strength"}, message.strength());
  add_property(surface, {"area"}, message.area());
  add_property(surface, {"nx_a", "ny_a", "nz_a"}, message.normal_a());
  add_property(surface, {"nx_b", "ny_b", "nz_b"}, message.normal_b());
  surface.quality = message.quality();
  surface.volume = message.volume();
  return surface;
}

void write_mesh(FileFormat format, const core::Mesh& mesh, const std::vector<std::string>& comments,
                const Write& write, const std::vector<VertexProperty>& properties) {
  if (mesh.points.size() > std::size_t{std::numeric_limits<std::int32_t>::max()} ||
      mesh.triangles.size() > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
    throw ClientError(ExitCode::kLimit, "the mesh has too many elements for this format");
  }
  switch (format) {
    case FileFormat::kOff:
      return write(core::write_off(mesh));
    case FileFormat::kPly:
      return write_ply(mesh, comments, properties, write);
    case FileFormat::kObj:
      return write_obj(mesh, comments, write);
    case FileFormat::kStl:
      return write_stl(mesh, write);
    case FileFormat::kVtp:
      return write_vtp(mesh, columns_of(properties, mesh.points.size()), comments, write);
    default:
      throw ClientError(ExitCode::kInternal, "no mesh writer for " + std::string(extension_of(format)));
  }
}

void write_mesh(FileFormat format, const core::Mesh& mesh, const std::vector<std::string>& comments,
                AtomicFile& file, const std::vector<VertexProperty>& properties) {
  try {
    write_mesh(
        format, mesh, comments, [&](std::string_view bytes) { file.write(bytes); }, properties);
  } catch (const ClientError& error) {
    if (!error.file().empty()) throw;
    throw ClientError(error.exit_code(), error.what(), file.target());
  }
}

}  // namespace affskel::client
