// PLY (Turk 1994), binary: coordinates as double, columns by their types, faces as lists of vertex_indices.
// Lines alone are edges of vertex1 and vertex2.  Curves beside faces are faces a, b, b, the last ones, which a
// comment counts: meshio ends its program at any element but vertex and face, MeshLab, Open3D and VTK pass
// over edges beside faces, Blender shows an edge for the one and the other.
// Where there is a column E, vertices also have it as programs for people know it: E as `quality`, in single
// precision, and colours by the scale of the pictures, up to the largest E of the file.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/coding.h"
#include "client/base/colour.h"
#include "client/files/write/shape_writers.h"
#include "client/files/write/stored_type.h"
#include "client/text/printable.h"
#include "core/files/ply_display.h"

namespace affskel::client {
namespace {

class PlyWriter {
 public:
  PlyWriter(const ShapeFile& shape, const std::vector<std::string>& names)
      : shape_(shape), erosion_(shape.column("E")) {
    for (std::size_t i = 0; i < shape.columns.size(); ++i) {
      const PointColumn& column = shape.columns[i];
      if (erosion_ == nullptr || !core::is_ply_display(column.name))
        columns_.push_back({names[i], &column, stored_as(column)});
    }
    for (const PointColumn& column : shape.face_columns)
      face_columns_.push_back({column.name, &column, stored_as(column)});
    if (erosion_ == nullptr) return;
    for (const double e : erosion_->values) {
      if (std::isfinite(e)) highest_ = std::max(highest_, e);
    }
  }

  std::string header(bool faces, const std::vector<std::string>& comments) const {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    for (const std::string& comment : comments) text += "comment " + one_line(comment) + "\n";
    if (curve_faces() > 0)
      text += std::string(core::kPlyCurves) + std::to_string(curve_faces()) +
              " (the last faces: edges, with their second end twice)\n";
    text += "element vertex " + std::to_string(shape_.mesh().points.size()) +
            "\nproperty double x\nproperty double y\nproperty double z\n";
    for (const Column& column : columns_) text += property(column.name, column.stored);
    if (erosion_ != nullptr) {
      text += "property float quality\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
    }
    if (faces) {
      text += "element face " + std::to_string(shape_.mesh().triangles.size() + curve_faces()) +
              "\nproperty list uchar int vertex_indices\n";
      for (const Column& column : face_columns_) text += property(column.name, column.stored);
    }
    if (!shape_.segments.empty() && curve_faces() == 0) {
      text += "element edge " + std::to_string(shape_.segments.size()) +
              "\nproperty int vertex1\nproperty int vertex2\n";
    }
    return text + "end_header\n";
  }

  void append_curve(std::string& row, const core::Segment& segment) const {
    if (curve_faces() > 0) base::append(row, std::uint8_t{3});
    for (const std::uint32_t end : segment) base::append(row, static_cast<std::int32_t>(end));
    if (curve_faces() > 0) base::append(row, static_cast<std::int32_t>(segment[1]));
  }

  void append_face(std::string& row, std::size_t t) const {
    base::append(row, std::uint8_t{3});
    for (const std::uint32_t corner : shape_.mesh().triangles[t])
      base::append(row, static_cast<std::int32_t>(corner));
    for (const Column& column : face_columns_) append_stored(row, column.of->values[t], column.stored);
  }

  void append_vertex(std::string& row, std::size_t i) const {
    for (int c = 0; c < 3; ++c) base::append(row, shape_.mesh().points[i][c]);
    for (const Column& column : columns_) append_stored(row, column.of->values[i], column.stored);
    if (erosion_ == nullptr) return;
    const double erosion = erosion_->values[i];
    const Rgb colour = viridis(colour_position(erosion, highest_));
    base::append(row, static_cast<float>(erosion));
    for (const float part : {colour.r, colour.g, colour.b}) {
      base::append(row, static_cast<std::uint8_t>(std::lround(255 * part)));
    }
  }

 private:
  std::size_t curve_faces() const {
    return shape_.mesh().triangles.empty() || !face_columns_.empty() ? 0 : shape_.segments.size();
  }

  static std::string property(const std::string& name, Stored stored) {
    constexpr const char* kTypes[] = {"int", "uint", "double"};
    return std::string("property ") + kTypes[static_cast<std::size_t>(stored)] + " " + name + "\n";
  }

  struct Column {
    std::string name;
    const PointColumn* of;
    Stored stored;
  };

  const ShapeFile& shape_;
  const PointColumn* erosion_;  // may be null
  std::vector<Column> columns_, face_columns_;
  double highest_ = 0;
};

}  // namespace

void write_ply(const ShapeFile& shape, const std::vector<std::string>& names, bool faces,
               const std::vector<std::string>& comments, const WriteBytes& write) {
  const PlyWriter writer(shape, names);
  write(writer.header(faces, comments));
  std::string row;
  for (std::size_t i = 0; i < shape.mesh().points.size(); ++i) {
    row.clear();
    writer.append_vertex(row, i);
    write(row);
  }
  for (std::size_t t = 0; t < shape.mesh().triangles.size(); ++t) {
    row.clear();
    writer.append_face(row, t);
    write(row);
  }
  for (const core::Segment& segment : shape.segments) {
    row.clear();
    writer.append_curve(row, segment);
    write(row);
  }
}

}  // namespace affskel::client
