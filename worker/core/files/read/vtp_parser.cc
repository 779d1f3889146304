// VTK XML PolyData: points, arrays per point, and cells of which lines, polygons and strips of triangles are
// taken; in one or several pieces, which are put together.
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/number_text.h"
#include "core/files/read/shape_parsers.h"
#include "core/files/read/vtk_data.h"
#include "core/files/read/vtp_description.h"
#include "core/files/vtk_arrays.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

constexpr std::size_t kMaxColumns = 4096;  // of all arrays together; far more than any file has

class VtpReader {
 public:
  explicit VtpReader(std::string_view bytes)
      : description_(read_vtp_description(bytes)), values_left_(bytes.size()) {}

  ShapeFile run() {
    if (description_.pieces.empty()) fail_at(0, "the file holds no <Piece>");
    for (VtpPiece& piece : description_.pieces) {
      ++pieces_begun_;
      first_point_ = file_.off.mesh.points.size();
      read_points(piece);
      read_columns(piece);
      for (const char* section : {"Verts", "Lines", "Polys", "Strips"}) read_cells(piece, section);
      piece = {};  // a file may be made of very many empty ones
    }
    return std::move(file_);
  }

 private:
  // A value takes at least a byte of the file.  More values than bytes mean that arrays share their bytes,
  // which could take any amount of memory.
  base::PackedNumbers numbers(const VtkArray& array) {
    base::PackedNumbers values = vtk_numbers(array, description_.encoding);
    if (values.size() > values_left_) {
      fail_at(array.line, "array " + quoted_excerpt(array.name) +
                              " takes the file beyond one value per byte; arrays must not share their data");
    }
    values_left_ -= values.size();
    return values;
  }

  void read_points(VtpPiece& piece) {
    const std::vector<VtkArray>& arrays = piece.arrays["Points"];
    if (!arrays.empty()) add_points(arrays.front());
    check_count(piece, "Points", file_.off.mesh.points.size() - first_point_);
  }

  static void check_count(const VtpPiece& piece, const std::string& what, std::size_t count) {
    const auto announced = piece.announced.find(what);
    if (announced == piece.announced.end() || announced->second == count) return;
    fail_at(piece.line, "the piece announces NumberOf" + what + " " + std::to_string(announced->second) +
                            ", but holds " + std::to_string(count));
  }

  void add_points(const VtkArray& array) {
    const base::PackedNumbers xyz = numbers(array);
    if (array.components != 3 || xyz.size() % 3 != 0)
      fail_at(array.line, "points must have three coordinates");
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      const Vec3 point = {xyz[i], xyz[i + 1], xyz[i + 2]};
      if (!is_finite(point)) {
        fail_at(array.line, "point " + std::to_string(i / 3) + " has a coordinate that is not finite");
      }
      file_.off.mesh.points.push_back(point);
    }
  }

  void read_columns(VtpPiece& piece) {
    const bool empty = file_.off.mesh.points.size() == first_point_;
    const bool known = !file_.columns.empty();
    columns_filled_ = 0;
    for (const VtkArray& array : piece.arrays["PointData"]) {
      if (!is_vtk_number(array.type)) continue;
      const base::PackedNumbers values = point_values(array);
      // An empty piece adds no columns: names without values could cost far more than the file is long.
      if (!(empty && known)) add_values(array, values);
    }
    if (empty || columns_filled_ == file_.columns.size()) return;
    for (const PointColumn& column : file_.columns) {
      if (column.values.size() != file_.off.mesh.points.size()) {
        fail_at(piece.line,
                "this piece is without the values of " + quoted_excerpt(column.name) + " that others have");
      }
    }
  }

  base::PackedNumbers point_values(const VtkArray& array) {
    const std::size_t points = file_.off.mesh.points.size() - first_point_;
    if (array.components == 0 || array.components > kMaxColumns) {
      fail_at(array.line, "array " + quoted_excerpt(array.name) + " has " + std::to_string(array.components) +
                              " components; 1 to " + std::to_string(kMaxColumns) + " are read");
    }
    base::PackedNumbers values = numbers(array);
    if (values.size() != points * array.components) {
      fail_at(array.line, "array " + quoted_excerpt(array.name) + " has " + std::to_string(values.size()) +
                              " numbers for " + std::to_string(points) + " points of " +
                              std::to_string(array.components) + " components");
    }
    return values;
  }

  void add_values(const VtkArray& array, const base::PackedNumbers& values) {
    const std::vector<std::string> names = columns_of_array(array.name, array.components);
    for (std::size_t c = 0; c < names.size(); ++c) {
      PointColumn& column = column_of(names[c], array);
      for (std::size_t v = c; v < values.size(); v += names.size()) column.values.push_back(values[v]);
      ++columns_filled_;
    }
  }

  PointColumn& column_of(const std::string& name, const VtkArray& array) {
    const auto [place, is_new] = places_.try_emplace(name, ColumnPlace{file_.columns.size(), pieces_begun_});
    if (!is_new) {
      if (std::exchange(place->second.piece, pieces_begun_) == pieces_begun_) {
        fail_at(array.line, "two arrays give values called " + quoted_excerpt(name));
      }
      PointColumn& column = file_.columns[place->second.index];
      column.whole = column.whole && is_vtk_whole(array.type);
      return column;
    }
    if (first_point_ > 0) {
      fail_at(array.line, "the pieces before are without the values of " + quoted_excerpt(name));
    }
    if (file_.columns.size() == kMaxColumns) {
      fail_at(array.line, "the arrays have more than " + std::to_string(kMaxColumns) + " components in all");
    }
    file_.columns.push_back({name, is_vtk_whole(array.type), {}});
    return file_.columns.back();
  }

  static const VtkArray* find_array(const std::vector<VtkArray>& arrays, std::string_view name) {
    const auto found =
        std::find_if(arrays.begin(), arrays.end(), [&](const VtkArray& a) { return a.name == name; });
    return found == arrays.end() ? nullptr : &*found;
  }

  // An array of whole numbers; the place and the numbers of none are empty.
  struct WholeNumbers {
    const char* name;
    std::uint64_t line = 0;
    base::PackedNumbers numbers;

    std::int64_t operator[](std::size_t i) const {
      const double value = numbers[i];
      if (!(std::abs(value) <= 0x1p52 && value == std::floor(value)))
        fail_at(line, std::string("the ") + name + " hold a number that is not whole");
      return static_cast<std::int64_t>(value);
    }
  };
  WholeNumbers whole_numbers(const VtpPiece& piece, const std::vector<VtkArray>& arrays, const char* name) {
    const VtkArray* found = find_array(arrays, name);
    if (found == nullptr) return {name, piece.line, {}};
    return {name, found->line, numbers(*found)};
  }

  // Cells of the section `Verts` are only counted.
  void read_cells(VtpPiece& piece, const std::string& section) {
    if (section == "Verts" && !piece.announced.contains(section)) return;
    const std::vector<VtkArray>& arrays = piece.arrays[section];
    const WholeNumbers corners = whole_numbers(piece, arrays, "connectivity"),
                       ends = whole_numbers(piece, arrays, "offsets");
    check_count(piece, section, ends.numbers.size());
    check_ends(ends, corners, section);
    if (section == "Verts") return;
    std::vector<std::int64_t> cell;
    for (std::size_t i = 0, begin = 0; i < ends.numbers.size(); ++i) {
      const auto end = static_cast<std::size_t>(ends[i]);
      cell.clear();
      for (; begin < end; ++begin) cell.push_back(vertex(corners[begin]));
      add_cell(section, cell, i, corners.line);
    }
  }

  void add_cell(const std::string& section, const std::vector<std::int64_t>& corners, std::size_t index,
                std::uint64_t line) {
    if (section == "Lines") return add_polyline(file_, corners, "line " + std::to_string(index), line);
    if (section == "Strips") return add_strip(corners, index, line);
    add_face(corners, "polygon " + std::to_string(index), line);
  }

  // The vertex of all pieces for one of the piece in hand; -1 when there is none.
  std::int64_t vertex(std::int64_t corner) const {
    const auto first = static_cast<std::int64_t>(first_point_);
    return corner < 0 || corner >= static_cast<std::int64_t>(file_.off.mesh.points.size()) - first
               ? -1
               : corner + first;
  }

  static void check_ends(const WholeNumbers& ends, const WholeNumbers& corners, const std::string& section) {
    std::int64_t last = 0;
    bool fit = true;
    for (std::size_t i = 0; i < ends.numbers.size(); ++i) {
      const std::int64_t end = ends[i];
      fit = fit && last <= end;
      last = end;
    }
    if (!fit || last != static_cast<std::int64_t>(corners.numbers.size())) {
      fail_at(corners.line, "the offsets of " + section + " do not fit their connectivity of " +
                                std::to_string(corners.numbers.size()) + " corners");
    }
  }

  void add_face(const std::vector<std::int64_t>& corners, const std::string& place, std::uint64_t line) {
    add_polygon(file_, corners, place, line);
    ++file_.off.polygons;
  }

  // Every corner from the third on makes a triangle with the two before it, every other one turned over.
  // Triangles with equal corners join strips into one and are left out.
  void add_strip(const std::vector<std::int64_t>& corners, std::size_t strip, std::uint64_t line) {
    const std::string place = "strip " + std::to_string(strip);
    if (corners.size() < 3) {
      fail_at(line, place + " has " + base::counted(corners.size(), "corner") + ", needs 3");
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const std::int64_t a = corners[i - 2], b = corners[i - 1], c = corners[i];
      if ((a == b || b == c || c == a) && std::min({a, b, c}) >= 0) continue;
      const bool turned = i % 2 != 0;
      add_face({turned ? b : a, turned ? a : b, c}, place + ", triangle " + std::to_string(i - 2), line);
    }
  }

  // Where a column is, and the last piece that gave it values, counted from 1.
  struct ColumnPlace {
    std::size_t index, piece;
  };

  VtpDescription description_;
  std::uint64_t values_left_;
  std::size_t pieces_begun_ = 0;
  std::size_t first_point_ = 0;     // of the piece in hand
  std::size_t columns_filled_ = 0;  // by the piece in hand
  std::unordered_map<std::string, ColumnPlace> places_;
  ShapeFile file_;
};

}  // namespace

ShapeFile parse_vtp(std::string_view bytes) {
  return VtpReader(bytes).run();
}

}  // namespace affskel::core
