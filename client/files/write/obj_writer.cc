#include <cstdint>
#include <span>

#include "base/number_text.h"
#include "client/files/write/shape_writers.h"
#include "client/text/printable.h"
#include "core/files/numbers.h"
#include "core/mesh/polylines.h"

namespace affskel::client {
namespace {

// The kind of row, then vertices, counted from 1.
std::string row_of(char kind, std::span<const std::uint32_t> vertices) {
  std::string text(1, kind);
  for (const std::uint32_t vertex : vertices) {
    text.push_back(' ');
    core::append_integer(text, std::uint64_t{vertex} + 1);
  }
  return text + "\n";
}

}  // namespace

void write_obj(const ShapeFile& shape, const std::vector<std::string>& comments, const WriteBytes& write) {
  const core::Mesh& mesh = shape.mesh();
  std::string text;
  for (const std::string& comment : comments) text += "# " + one_line(comment) + "\n";
  write(text);
  for (const core::Vec3& p : mesh.points) {
    write("v " + base::to_text(p.x) + " " + base::to_text(p.y) + " " + base::to_text(p.z) + "\n");
  }
  // Objects of their own: Open3D and others that read by Assimp leave out an object that holds both.
  const bool both = !mesh.triangles.empty() && !shape.segments.empty();
  if (both) write("o sheet\n");
  for (const core::Triangle& t : mesh.triangles) write(row_of('f', t));
  if (both) write("o curves\n");
  for (const auto& line : core::polylines(mesh.points.size(), shape.segments)) write(row_of('l', line));
}

}  // namespace affskel::client
