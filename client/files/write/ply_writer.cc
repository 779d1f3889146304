// PLY (Turk 1994), binary: coordinates as double, columns by their types, faces as lists of vertex_indices.
#include <cstdint>

#include "base/coding.h"
#include "client/files/numbers.h"
#include "client/files/write/shape_writers.h"
#include "client/files/write/stored_type.h"
#include "client/text/printable.h"

namespace affskel::client {
namespace {

std::string ply_header(const ShapeFile& shape, const std::vector<std::string>& names, bool faces,
                       const std::vector<Stored>& stored, const std::vector<std::string>& comments) {
  constexpr const char* kTypes[] = {"int", "uint", "double"};
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) text += "comment " + one_line(comment) + "\n";
  text += "element vertex " + std::to_string(shape.mesh().points.size()) +
          "\nproperty double x\nproperty double y\nproperty double z\n";
  for (std::size_t i = 0; i < stored.size(); ++i) {
    text += std::string("property ") + kTypes[static_cast<std::size_t>(stored[i])] + " " + names[i] + "\n";
  }
  if (faces) {
    text += "element face " + std::to_string(shape.mesh().triangles.size()) +
            "\nproperty list uchar int vertex_indices\n";
  }
  return text + "end_header\n";
}

}  // namespace

void write_ply(const ShapeFile& shape, const std::vector<std::string>& names, bool faces,
               const std::vector<std::string>& comments, const WriteBytes& write) {
  std::vector<Stored> stored;
  for (const PointColumn& column : shape.columns) stored.push_back(stored_as(column));
  write(ply_header(shape, names, faces, stored, comments));
  std::string row;
  for (std::size_t i = 0; i < shape.mesh().points.size(); ++i) {
    row.clear();
    for (int c = 0; c < 3; ++c) base::append(row, shape.mesh().points[i][c]);
    for (std::size_t k = 0; k < stored.size(); ++k) {
      append_stored(row, shape.columns[k].values[i], stored[k]);
    }
    write(row);
  }
  for (const core::Triangle& t : shape.mesh().triangles) {
    row.clear();
    base::append(row, std::uint8_t{3});
    for (const std::uint32_t corner : t) base::append(row, static_cast<std::int32_t>(corner));
    write(row);
  }
}

}  // namespace affskel::client
