// VTK XML (VTK User's Guide, "XML File Formats"): a text that describes the arrays, then `_` and the arrays
// themselves, each behind the number of its bytes; `offset` counts from behind the `_`.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "base/coding.h"
#include "client/files/numbers.h"
#include "client/files/vtk_arrays.h"
#include "client/files/write/shape_writers.h"
#include "client/files/write/stored_type.h"
#include "client/text/markup_text.h"
#include "client/text/printable.h"

namespace affskel::client {
namespace {

const char* vtk_type(Stored stored) {
  constexpr const char* kTypes[] = {"Int32", "UInt32", "Float64"};
  return kTypes[static_cast<std::size_t>(stored)];
}

class VtpWriter {
 public:
  VtpWriter(const core::Mesh& mesh, const std::vector<PointColumn>& columns, const WriteBytes& write)
      : mesh_(mesh), columns_(columns), write_(write) {}

  void run(const std::vector<std::string>& comments) {
    const std::string points = std::to_string(mesh_.points.size());
    const bool surface = !mesh_.triangles.empty();
    text_ =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<PolyData>\n";
    describe_comments(comments);
    text_ += "<Piece NumberOfPoints=\"" + points + "\" NumberOfVerts=\"" + (surface ? "0" : points) +
             "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
             std::to_string(mesh_.triangles.size()) + "\">\n";
    describe_columns();
    describe_points();
    if (surface) {
      describe_cells("Polys", mesh_.triangles.size(), 3);
    } else {
      describe_cells("Verts", mesh_.points.size(), 1);
    }
    write_(text_ + "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    for (const Block& block : blocks_) {
      std::string length;
      base::append(length, block.bytes);
      write_(length);
      block.fill();
    }
    write_("\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  struct Block {
    std::uint64_t bytes;
    std::function<void()> fill;
  };

  // An array whose `bytes` are written by `fill` when its turn comes.
  void describe(const std::string& attributes, std::uint64_t bytes, std::function<void()> fill,
                const char* tag = "DataArray") {
    text_ += std::string("<") + tag + " " + attributes + " format=\"appended\" offset=\"" +
             std::to_string(offset_) + "\"/>\n";
    offset_ += sizeof(std::uint64_t) + bytes;
    blocks_.push_back({bytes, std::move(fill)});
  }

  void describe_comments(const std::vector<std::string>& comments) {
    if (comments.empty()) return;
    std::string strings;
    for (const std::string& comment : comments) (strings += one_line(comment)).push_back('\0');
    text_ += "<FieldData>\n";
    describe(
        "type=\"String\" Name=\"comment\" NumberOfTuples=\"" + std::to_string(comments.size()) + "\"",
        strings.size(), [this, strings] { write_(strings); }, "Array");
    text_ += "</FieldData>\n";
  }

  bool has(std::string_view name) const {
    return std::any_of(columns_.begin(), columns_.end(),
                       [&](const PointColumn& c) { return c.name == name; });
  }

  void describe_columns() {
    text_ += has("E") ? "<PointData Scalars=\"E\">\n" : "<PointData>\n";
    for (std::size_t c = 0; c < columns_.size();) {
      std::string vector;
      if (c + 2 < columns_.size()) {
        vector = array_of_columns(columns_[c].name, columns_[c + 1].name, columns_[c + 2].name);
      }
      // Two arrays of one name would hide each other.
      if (vector.empty() || has(vector)) {
        describe_array(columns_[c].name, {&columns_[c], 1});
        ++c;
      } else {
        describe_array(vector, {&columns_[c], 3});
        c += 3;
      }
    }
    text_ += "</PointData>\n";
  }

  void describe_array(const std::string& name, std::span<const PointColumn> parts) {
    Stored stored = stored_as(parts[0]);
    for (const PointColumn& part : parts) {
      if (stored_as(part) != stored) stored = Stored::kDouble;
    }
    std::string attributes =
        std::string("type=\"") + vtk_type(stored) + "\" Name=\"" + markup_text(name) + "\"";
    if (parts.size() > 1) attributes += " NumberOfComponents=\"" + std::to_string(parts.size()) + "\"";
    describe(attributes, parts.size() * mesh_.points.size() * bytes_of(stored), [this, parts, stored] {
      std::string row;
      for (std::size_t p = 0; p < mesh_.points.size(); ++p) {
        row.clear();
        for (const PointColumn& part : parts) append_stored(row, part.values[p], stored);
        write_(row);
      }
    });
  }

  void describe_points() {
    text_ += "<Points>\n";
    describe("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"",
             3 * sizeof(double) * mesh_.points.size(), [this] {
               std::string row;
               for (const core::Vec3& p : mesh_.points) {
                 row.clear();
                 for (int c = 0; c < 3; ++c) base::append(row, p[c]);
                 write_(row);
               }
             });
    text_ += "</Points>\n";
  }

  // Corners of all cells one after the other, then per cell where its corners end.
  void describe_cells(const std::string& section, std::size_t cells, std::size_t corners) {
    const auto whole_numbers = [&](const char* name, std::size_t count, auto number) {
      describe(std::string("type=\"Int64\" Name=\"") + name + "\"", count * sizeof(std::int64_t),
               [this, count, number] {
                 std::string row;
                 for (std::size_t i = 0; i < count; ++i) {
                   row.clear();
                   base::append(row, static_cast<std::int64_t>(number(i)));
                   write_(row);
                 }
               });
    };
    text_ += "<" + section + ">\n";
    whole_numbers("connectivity", cells * corners, [this, corners](std::size_t i) -> std::size_t {
      return corners == 3 ? mesh_.triangles[i / 3][i % 3] : i;
    });
    whole_numbers("offsets", cells, [corners](std::size_t i) { return corners * (i + 1); });
    text_ += "</" + section + ">\n";
  }

  const core::Mesh& mesh_;
  const std::vector<PointColumn>& columns_;
  const WriteBytes& write_;
  std::string text_;
  std::uint64_t offset_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace

void write_vtp(const core::Mesh& mesh, const std::vector<PointColumn>& columns,
               const std::vector<std::string>& comments, const WriteBytes& write) {
  VtpWriter(mesh, columns, write).run(comments);
}

}  // namespace affskel::client
