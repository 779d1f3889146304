// VTK XML (VTK User's Guide, "XML File Formats"), with the arrays inline: ParaView 5.11 does not load
// appended raw data.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "base/coding.h"
#include "client/files/write/shape_writers.h"
#include "client/files/write/stored_type.h"
#include "client/text/markup_text.h"
#include "client/text/printable.h"
#include "core/files/vtk_arrays.h"
#include "core/files/vtk_inline_data.h"
#include "core/mesh/polylines.h"

namespace affskel::client {
namespace {

const char* vtk_type(Stored stored) {
  constexpr const char* kTypes[] = {"Int32", "UInt32", "Float64"};
  return kTypes[static_cast<std::size_t>(stored)];
}

class VtpWriter {
 public:
  VtpWriter(const ShapeFile& shape, const std::vector<PointColumn>& columns, const WriteBytes& write)
      : mesh_(shape.mesh()),
        is_surface_(shape.is_surface()),
        lines_(core::polylines(shape.mesh().points.size(), shape.segments)),
        columns_(columns),
        face_columns_(shape.face_columns),
        write_(write) {}

  void run(const std::vector<std::string>& comments) {
    const std::string points = std::to_string(mesh_.points.size());
    write_(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<PolyData>\n");
    write_comments(comments);
    write_("<Piece NumberOfPoints=\"" + points + "\" NumberOfVerts=\"" + (is_surface_ ? "0" : points) +
           "\" NumberOfLines=\"" + std::to_string(lines_.size()) +
           "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(mesh_.triangles.size()) + "\">\n");
    write_columns();
    write_face_columns();
    write_points();
    if (!lines_.empty()) write_cells("Lines", lines_);
    if (is_surface_) {
      write_cells("Polys", mesh_.triangles);
    } else {
      std::vector<std::array<std::uint32_t, 1>> verts(mesh_.points.size());
      for (std::uint32_t p = 0; p < verts.size(); ++p) verts[p] = {p};
      write_cells("Verts", verts);
    }
    write_("</Piece>\n</PolyData>\n</VTKFile>\n");
  }

 private:
  void write_array(const std::string& attributes, const std::string& bytes,
                   const std::string& tag = "DataArray") {
    write_("<" + tag + " " + attributes + " format=\"binary\">\n" + core::vtk_inline(bytes) + "\n</" + tag +
           ">\n");
  }

  void write_comments(const std::vector<std::string>& comments) {
    if (comments.empty()) return;
    std::string strings;
    for (const std::string& comment : comments) (strings += one_line(comment)).push_back('\0');
    write_("<FieldData>\n");
    write_array("type=\"String\" Name=\"comment\" NumberOfTuples=\"" + std::to_string(comments.size()) + "\"",
                strings, "Array");
    write_("</FieldData>\n");
  }

  bool has(std::string_view name) const {
    return std::any_of(columns_.begin(), columns_.end(),
                       [&](const PointColumn& c) { return c.name == name; });
  }

  void write_columns() {
    write_(has("E") ? "<PointData Scalars=\"E\">\n" : "<PointData>\n");
    for (std::size_t c = 0; c < columns_.size();) {
      std::string vector;
      if (c + 2 < columns_.size()) {
        vector = core::array_of_columns(columns_[c].name, columns_[c + 1].name, columns_[c + 2].name);
      }
      // Two arrays of one name would hide each other.
      if (vector.empty() || has(vector)) {
        write_column(columns_[c].name, {&columns_[c], 1});
        ++c;
      } else {
        write_column(vector, {&columns_[c], 3});
        c += 3;
      }
    }
    write_("</PointData>\n");
  }

  // Values of cells; lines would come before triangles, and have none.
  void write_face_columns() {
    if (face_columns_.empty() || !lines_.empty()) return;
    write_("<CellData Scalars=\"" + markup_text(face_columns_.front().name) + "\">\n");
    for (const PointColumn& column : face_columns_) write_column(column.name, {&column, 1});
    write_("</CellData>\n");
  }

  void write_column(const std::string& name, std::span<const PointColumn> parts) {
    Stored stored = stored_as(parts[0]);
    for (const PointColumn& part : parts) {
      if (stored_as(part) != stored) stored = Stored::kDouble;
    }
    std::string attributes =
        std::string("type=\"") + vtk_type(stored) + "\" Name=\"" + markup_text(name) + "\"";
    if (parts.size() > 1) attributes += " NumberOfComponents=\"" + std::to_string(parts.size()) + "\"";
    std::string bytes;
    bytes.reserve(parts.size() * parts[0].values.size() * bytes_of(stored));
    for (std::size_t n = 0; n < parts[0].values.size(); ++n) {
      for (const PointColumn& part : parts) append_stored(bytes, part.values[n], stored);
    }
    write_array(attributes, bytes);
  }

  void write_points() {
    std::string bytes;
    bytes.reserve(3 * sizeof(double) * mesh_.points.size());
    for (const core::Vec3& p : mesh_.points) {
      for (int c = 0; c < 3; ++c) base::append(bytes, p[c]);
    }
    write_("<Points>\n");
    write_array("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", bytes);
    write_("</Points>\n");
  }

  // Points of all cells one after the other, then per cell where its points end.
  template <typename Cells>
  void write_cells(const std::string& section, const Cells& cells) {
    std::string points, ends;
    std::int64_t end = 0;
    for (const auto& cell : cells) {
      for (const std::uint32_t point : cell) base::append(points, std::int64_t{point});
      end += static_cast<std::int64_t>(cell.size());
      base::append(ends, end);
    }
    write_("<" + section + ">\n");
    write_array("type=\"Int64\" Name=\"connectivity\"", points);
    write_array("type=\"Int64\" Name=\"offsets\"", ends);
    write_("</" + section + ">\n");
  }

  const core::Mesh& mesh_;
  const bool is_surface_;
  const std::vector<std::vector<std::uint32_t>> lines_;
  const std::vector<PointColumn>& columns_;
  const std::vector<PointColumn>& face_columns_;
  const WriteBytes& write_;
};

}  // namespace

void write_vtp(const ShapeFile& shape, const std::vector<PointColumn>& columns,
               const std::vector<std::string>& comments, const WriteBytes& write) {
  VtpWriter(shape, columns, write).run(comments);
}

}  // namespace affskel::client
