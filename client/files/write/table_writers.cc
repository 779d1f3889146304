// Points as rows of numbers: .csv with a header line, .xyz without.
#include "client/files/write/shape_writers.h"
#include "core/files/numbers.h"

namespace affskel::client {

void write_csv(const ShapeFile& shape, const std::vector<std::string>& names, const WriteBytes& write) {
  std::string row = "x,y,z";
  for (const std::string& name : names) row += "," + name;
  write(row + "\n");
  for (std::size_t i = 0; i < shape.mesh().points.size(); ++i) {
    row.clear();
    for (int c = 0; c < 3; ++c) {
      if (c > 0) row.push_back(',');
      core::append_exact(row, shape.mesh().points[i][c]);
    }
    for (const PointColumn& column : shape.columns) {
      row.push_back(',');
      core::append_exact(row, column.values[i]);
    }
    row.push_back('\n');
    write(row);
  }
}

void write_xyz(const ShapeFile& shape, const WriteBytes& write) {
  std::string row;
  for (const core::Vec3& p : shape.mesh().points) {
    row.clear();
    for (int c = 0; c < 3; ++c) {
      core::append_exact(row, p[c]);
      row.push_back(c < 2 ? ' ' : '\n');
    }
    write(row);
  }
}

}  // namespace affskel::client
