// PLY (Turk 1994): a text header that declares elements with typed properties, then their values in the
// same order, as text (one row per entry) or as bytes of either order.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/files/ply_display.h"
#include "core/files/read/ply_header.h"
#include "core/files/read/shape_parsers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

// The values of the body, one after the other.
class Values {
 public:
  explicit Values(const PlyHeader& header)
      : encoding_(header.encoding), bytes_(header.body), rows_(header.body, header.lines) {}

  // Values are taken between begin and end of their entry; place names it in messages.
  void begin(const std::string& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
    word_ = 0;
    if (encoding_ == PlyEncoding::kText && !rows_.next()) fail("the file ends before");
  }

  double next(const PlyType& type) {
    if (encoding_ == PlyEncoding::kText) return next_word(type);
    if (bytes_.size() < type.kind.bytes) fail("the file ends inside");
    const double value = type.kind.decode(bytes_.data(), encoding_ == PlyEncoding::kBig);
    bytes_.remove_prefix(type.kind.bytes);
    return value;
  }

  void end() const {
    if (encoding_ == PlyEncoding::kText && word_ != rows_.words().size())
      fail("too many numbers in the row of");
  }

  void end_of_file() {
    const bool more = encoding_ == PlyEncoding::kText ? rows_.next() : !bytes_.empty();
    if (more) fail_at(line(), "the file goes on after the last entry that the header announces");
  }

  std::uint64_t line() const { return encoding_ == PlyEncoding::kText ? rows_.line() : 0; }
  // Every entry takes at least a byte.
  std::size_t bytes_left() const {
    return encoding_ == PlyEncoding::kText ? rows_.bytes_left() + rows_.text().size() + 1 : bytes_.size();
  }
  std::string place() const { return *element_ + " " + std::to_string(index_); }

 private:
  [[noreturn]] void fail(const std::string& what) const { fail_at(line(), what + " " + place()); }

  double next_word(const PlyType& type) {
    if (word_ == rows_.words().size()) fail("too few numbers in the row of");
    const std::string_view word = rows_.words()[word_++];
    double value = 0;
    try {
      value = parse_number(word, rows_.line(), "a value");
    } catch (const CoreError&) {
      fail_at(line(), quoted_excerpt(word) + " is not a number, in " + place());
    }
    if (!type.whole) return value;
    if (value != std::floor(value)) {
      fail_at(line(), quoted_excerpt(word) + " is not a whole number, in " + place());
    }
    if (!(value >= type.least && value <= type.most)) {
      fail_at(line(), quoted_excerpt(word) + " is outside the range of its type (" +
                          base::to_text(type.least) + " to " + base::to_text(type.most) + "), in " + place());
    }
    return value;
  }

  PlyEncoding encoding_;
  std::string_view bytes_;
  TextRows rows_;
  const std::string* element_ = nullptr;
  std::uint64_t index_ = 0;
  std::size_t word_ = 0;
};

class PlyReader {
 public:
  explicit PlyReader(std::string_view bytes) : header_(read_ply_header(bytes)), values_(header_) {}

  ShapeFile run() {
    bool has_vertices = false;
    for (const PlyElement& element : header_.elements) {
      check_count(element);
      if (element.name == "vertex") {
        if (has_vertices) fail_at(header_.lines, "two elements are called vertex");
        read_vertices(element);
        has_vertices = true;
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "edge" && has_ends(element)) {
        read_edges(element);
      } else {
        pass_over(element);
      }
    }
    if (!has_vertices) fail_at(header_.lines, "the header announces no vertices");
    values_.end_of_file();
    return std::move(file_);
  }

 private:
  // Refuses what cannot be true before anything is allocated.
  void check_count(const PlyElement& element) const {
    if (element.properties.empty() && element.count > 0) {
      fail_at(header_.lines, "element " + quoted_excerpt(element.name) + " has no properties");
    }
    if (element.count > values_.bytes_left() || element.count > std::numeric_limits<std::uint32_t>::max()) {
      fail_at(header_.lines, std::to_string(element.count) + " entries of element " +
                                 quoted_excerpt(element.name) + " announced, but only " +
                                 std::to_string(values_.bytes_left()) + " bytes follow");
    }
  }

  // A vertex by its index, which some programs write as a number of type float.
  std::int64_t whole_index(double value) const {
    if (!(std::abs(value) <= 0x1p52 && value == std::floor(value))) {
      fail_at(values_.line(),
              values_.place() + " uses vertex " + base::to_text(value) + ", which is not a whole number");
    }
    return static_cast<std::int64_t>(value);
  }

  const std::vector<double>& next_list(const PlyProperty& property) {
    const double length = values_.next(*property.count_type);
    if (!(length >= 0) || length > static_cast<double>(values_.bytes_left())) {
      fail_at(values_.line(), values_.place() + " announces a list of " + base::to_text(length) + " values");
    }
    list_.clear();
    for (double i = 0; i < length; ++i) list_.push_back(values_.next(*property.type));
    return list_;
  }

  const std::vector<std::int64_t>& next_corners(const PlyProperty& property) {
    corners_.clear();
    for (const double value : next_list(property)) corners_.push_back(whole_index(value));
    return corners_;
  }

  void pass_over(const PlyProperty& property) {
    if (property.list) {
      next_list(property);
    } else {
      values_.next(*property.type);
    }
  }

  void pass_over(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_.begin(element.name, i);
      if (i == 0)
        file_.off.passed_over.push_back({quoted_excerpt(element.name), element.count, values_.line()});
      for (const PlyProperty& property : element.properties) pass_over(property);
      values_.end();
    }
  }

  void read_vertices(const PlyElement& element) {
    // Per property where its value goes: 0, 1, 2 a coordinate, 3 + i column i.
    std::vector<std::size_t> target;
    for (const PlyProperty& p : element.properties) {
      if (p.list) fail_at(header_.lines, "a list of each vertex (" + p.name + ") is not supported");
      if (p.name == "x" || p.name == "y" || p.name == "z") {
        target.push_back(static_cast<std::size_t>(p.name[0] - 'x'));
      } else {
        target.push_back(3 + file_.columns.size());
        file_.columns.push_back({p.name, p.type->whole, {}});
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (std::count(target.begin(), target.end(), c) != 1) {
        fail_at(header_.lines, "the vertices must have each of x, y and z once");
      }
    }
    for (std::uint64_t i = 0; i < element.count; ++i) read_vertex(element, target, i);
  }

  void read_vertex(const PlyElement& element, const std::vector<std::size_t>& target, std::uint64_t index) {
    values_.begin(element.name, index);
    Vec3 at;
    for (std::size_t p = 0; p < target.size(); ++p) {
      const double value = values_.next(*element.properties[p].type);
      if (target[p] >= 3) {
        file_.columns[target[p] - 3].values.push_back(value);
        continue;
      }
      if (!std::isfinite(value)) {
        fail_at(values_.line(), values_.place() + " has a coordinate that is not finite");
      }
      at[target[p]] = value;
    }
    values_.end();
    file_.off.mesh.points.push_back(at);
    if (values_.line() > 0) file_.off.vertex_line.push_back(static_cast<std::uint32_t>(values_.line()));
  }

  void read_faces(const PlyElement& element) {
    const auto is_corners = [](const PlyProperty& p) {
      return p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (element.count > 0 && std::none_of(element.properties.begin(), element.properties.end(), is_corners)) {
      fail_at(header_.lines, "the faces have no list of vertex_indices");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_.begin(element.name, i);
      for (const PlyProperty& p : element.properties) {
        if (is_corners(p)) {
          add_face_or_curve(next_corners(p), header_.curve_faces >= element.count - i);
        } else {
          pass_over(p);
        }
      }
      values_.end();
    }
  }

  static bool is_end(const PlyProperty& p) { return !p.list && (p.name == "vertex1" || p.name == "vertex2"); }

  static bool has_ends(const PlyElement& edges) {
    return std::any_of(edges.properties.begin(), edges.properties.end(), is_end);
  }

  // The ends of edges are called vertex1 and vertex2; what else an edge has is passed over.
  void read_edges(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      values_.begin(element.name, i);
      corners_.clear();
      for (const PlyProperty& p : element.properties) {
        if (is_end(p)) {
          corners_.push_back(whole_index(values_.next(*p.type)));
        } else {
          pass_over(p);
        }
      }
      values_.end();
      add_polyline(file_, corners_, values_.place(), values_.line());
    }
  }

  void add_face_or_curve(const std::vector<std::int64_t>& corners, bool may_be_curve) {
    if (may_be_curve && corners.size() == 3 && corners[1] == corners[2]) {
      add_polyline(file_, {corners[0], corners[1]}, values_.place(), values_.line());
    } else {
      add_face(corners);
    }
  }

  void add_face(const std::vector<std::int64_t>& corners) {
    add_polygon(file_, corners, values_.place(), values_.line());
    if (values_.line() > 0) {
      file_.off.triangle_line.resize(file_.off.mesh.triangles.size(),
                                     static_cast<std::uint32_t>(values_.line()));
    }
    ++file_.off.polygons;
  }

  PlyHeader header_;
  Values values_;
  std::vector<double> list_;
  std::vector<std::int64_t> corners_;
  ShapeFile file_;
};

}  // namespace

ShapeFile parse_ply(std::string_view bytes) {
  ShapeFile file = PlyReader(bytes).run();
  if (file.column("E") != nullptr) {
    std::erase_if(file.columns, [](const PointColumn& column) { return is_ply_display(column.name); });
  }
  return file;
}

}  // namespace affskel::core
