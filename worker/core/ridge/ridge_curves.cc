// Notation.  A corner of a cell is a number 0 .. 7: bit k is a step along axis k from the cell's lowest
// corner. A tetrahedron is a way 0, a, b, 7 along the cell's edges.  v = grad P - (grad P . e) e with e =
// e_3.
//
// For a triangle of corners x, y, z with e oriented alike, D_xy = (e_x + e_y) . (v_x cross v_y) tells on
// which side of the line through v_x and v_y the origin lies.  It lies within the triangle of the v when
// D_xy, D_yz and D_zx have one sign; they are then the barycentric coordinates of z, x and y.
#include "core/ridge/ridge_curves.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>

#include "core/base/none.h"
#include "core/base/unit.h"
#include "core/lattice/lattice_edges.h"
#include "core/lattice/lattice_points.h"
#include "core/lattice/layer_index.h"

namespace affskel::core {
namespace {

// The lattice stands symmetrically about a solid.  There the axis of a symmetric one would meet the diagonals
// of cells, where the signs of several determinants are left to rounding: curves are looked for this much
// beside their place, spacings, in no special direction.
constexpr Vec3 kShift{0.36e-3, 0.48e-3, 0.8e-3};

using Chain = std::array<std::size_t, 3>;  // corners of a triangle, each above the one before

// The inner corners of the six tetrahedra 0, a, b, 7.
constexpr std::array<std::array<std::size_t, 2>, 6> kTetrahedra{
    {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}}};

// In the order in which a cell is loaded: 0 and 7 belong to all tetrahedra.
constexpr std::array<std::size_t, 8> kCorners{0, 7, 1, 2, 3, 4, 5, 6};

struct CurvePoint {
  SheetVertex at;
  struct Link {
    std::uint32_t to = kNone;    // the next point of the curve
    std::uint32_t cell = kNone;  // passed on the way: its lowest sample point
  };
  std::array<Link, 2> links;
};

// The eight corners of a cell, those that may lie near a curve.
struct CurveCell {
  std::array<std::uint32_t, 8> point{};  // kNone: none there, or no curve near
  std::array<Vec3, 8> e, v;
  std::array<std::array<double, 8>, 8> turn{}, det{};  // e oriented alike; D, e as at the lower corner
};

class CurveFinder {
 public:
  CurveFinder(const Lattice& lattice, const RidgeValues& values)
      : lattice_(lattice), values_(values), ranks_(lattice), open_(lattice.points, 0) {
    for_each_edge(lattice, [&](std::uint32_t x, std::uint32_t, std::uint8_t axis, const auto&) {
      open_[x] = static_cast<std::uint8_t>(open_[x] | 1U << axis);
    });
  }

  std::vector<CurvePoint> run(ExecutionContext* context) {
    std::int32_t reached = -1;
    for_each_point(lattice_, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t point) {
      for (; reached < i; ranks_.move_to(static_cast<std::uint32_t>(++reached))) throw_if_stopped(context);
      if (!near_curve(point)) return;
      place_ = {i, j, k};
      visit_cell();
    });
    return std::move(points_);
  }

 private:
  bool near_curve(std::uint32_t point) const {
    const PointRidge& ridge = values_.ridge(point);
    return ridge.least < 0 && ridge.ratio > 0;
  }

  bool open(std::uint32_t point, std::size_t step) const { return (open_[point] & step) != 0; }

  void visit_cell() {
    if (!load_corners()) return;
    compare_corners();
    for (const auto& [a, b] : kTetrahedra) {
      if (cell_.point[a] == kNone || cell_.point[b] == kNone || cell_.point[7] == kNone) continue;
      if (!open(cell_.point[0], a) || !open(cell_.point[a], b ^ a) || !open(cell_.point[b], 7 ^ b)) continue;
      const std::array<Chain, 4> faces{{{0, a, b}, {0, a, 7}, {0, b, 7}, {a, b, 7}}};
      std::array<std::uint32_t, 4> crossed{};
      std::size_t count = 0;
      for (const Chain& face : faces)
        if (const std::uint32_t found = crossing(face); found != kNone) crossed[count++] = found;
      if (count == 2) join(crossed[0], crossed[1]);
    }
  }

  // Whether a curve may pass: not where all v lie on one side.
  bool load_corners() {
    double least = 1;
    for (const std::size_t c : kCorners) {
      const std::uint32_t point = ranks_.at(place_[0] + static_cast<std::int32_t>(c & 1),
                                            place_[1] + static_cast<std::int32_t>(c >> 1 & 1),
                                            place_[2] + static_cast<std::int32_t>(c >> 2));
      cell_.point[c] = point != kNone && near_curve(point) ? point : kNone;
      if (cell_.point[c] == kNone) {
        if (c == 7) return false;  // a corner of all tetrahedra
        continue;
      }
      const PointRidge& ridge = values_.ridge(point);
      cell_.e[c] = vector_of(ridge.along);
      const Vec3 gradient = values_.gradient(point) - static_cast<double>(ridge.least) * kShift;
      cell_.v[c] = gradient - dot(gradient, cell_.e[c]) * cell_.e[c];
      least = std::min(least, dot(cell_.v[0], cell_.v[c]));
    }
    return least <= 0;
  }

  void compare_corners() {
    for (std::size_t c = 1; c < 8; ++c) {
      for (std::size_t low = 0; low < c && cell_.point[c] != kNone; ++low) {
        if ((low & c) != low || cell_.point[low] == kNone) continue;
        const double turn = dot(cell_.e[low], cell_.e[c]) < 0 ? -1 : 1;
        cell_.turn[low][c] = turn;
        cell_.det[low][c] = dot(cell_.e[low] + turn * cell_.e[c], cross(cell_.v[low], cell_.v[c]));
      }
    }
  }

  // Barycentric coordinates of the zero of v in a triangle.
  std::optional<std::array<double, 3>> zero_in(const Chain& face) const {
    const auto [x, y, z] = face;
    const double turn_y = cell_.turn[x][y], turn_z = cell_.turn[x][z];
    if (turn_y * turn_z != cell_.turn[y][z]) return std::nullopt;
    const double xy = cell_.det[x][y], yz = cell_.det[y][z], xz = cell_.det[x][z];
    const bool left = xy >= 0;
    if (left != (turn_y > 0 ? yz >= 0 : yz < 0) || left != (xz < 0)) return std::nullopt;
    const double sum = xy + turn_y * yz - xz;
    if (sum == 0) return std::nullopt;
    return std::array<double, 3>{turn_y * yz / sum, -xz / sum, xy / sum};
  }

  // The number of the point where a curve crosses a triangle, or kNone.
  std::uint32_t crossing(const Chain& face) {
    const std::optional<std::array<double, 3>> weights = zero_in(face);
    if (!weights) return kNone;
    const auto [x, y, z] = face;
    const std::uint64_t key = std::uint64_t{cell_.point[x]} << 6 | (y ^ x) << 3 | (z ^ x);
    const auto [known, fresh] = number_.try_emplace(key, kNone);
    if (!fresh) return known->second;
    const CurvePoint point = point_at(face, *weights);
    if (!values_.counts(point.at)) return kNone;
    points_.push_back(point);
    return known->second = static_cast<std::uint32_t>(points_.size() - 1);
  }

  CurvePoint point_at(const Chain& face, const std::array<double, 3>& weights) const {
    std::array<std::uint32_t, 3> points{};
    Vec3 place, across;
    CurvePoint result;
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t c = face[n];
      points[n] = cell_.point[c];
      place = place + weights[n] * Vec3{static_cast<double>(place_[0]) + static_cast<double>(c & 1),
                                        static_cast<double>(place_[1]) + static_cast<double>(c >> 1 & 1),
                                        static_cast<double>(place_[2]) + static_cast<double>(c >> 2)};
      const Vec3 e = vector_of(values_.ridge(points[n]).across);
      across = across + (dot(e, across) < 0 ? -weights[n] : weights[n]) * e;
    }
    result.at = values_.at(RidgeValues::Of::kCurve, lattice_.spacing * place, points, weights, unit(across));
    return result;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
      auto& links = points_[from].links;
      links[links[0].to == kNone ? 0 : 1] = {to, cell_.point[0]};
    }
  }

  const Lattice& lattice_;
  const RidgeValues& values_;
  LayerIndex ranks_;
  std::vector<std::uint8_t> open_;  // per point: bit k, the edge from it along axis k lies in the solid
  std::array<std::int32_t, 3> place_{};
  CurveCell cell_;
  std::map<std::uint64_t, std::uint32_t> number_;  // of crossed triangles
  std::vector<CurvePoint> points_;
};

// Follows the points from curve end to curve end, and makes one vertex of those within a cell.
class CurveTracer {
 public:
  explicit CurveTracer(const std::vector<CurvePoint>& points) : points_(points), passed_(points.size(), 0) {}

  std::vector<RidgeCurve> run() {
    for (std::uint32_t p = 0; p < points_.size(); ++p)
      if (!passed_[p] && points_[p].links[1].to == kNone) trace(p);
    for (std::uint32_t p = 0; p < points_.size(); ++p)
      if (!passed_[p]) trace(p);
    return std::move(curves_);
  }

 private:
  void trace(std::uint32_t start) {
    std::vector<std::uint32_t> way{start}, cells;  // cells[n] lies between way[n] and way[n + 1]
    passed_[start] = 1;
    const std::array<CurvePoint::Link, 2>& first = points_[start].links;
    const bool closed = first[1].to != kNone;
    CurvePoint::Link link = first[0];
    for (std::uint32_t at = start; link.to != kNone && !passed_[link.to];) {
      const std::uint32_t from = at;
      at = link.to;
      way.push_back(at);
      cells.push_back(link.cell);
      passed_[at] = 1;
      const auto& links = points_[at].links;
      link = links[links[0].to == from && links[0].cell == cells.back() ? 1 : 0];
    }
    if (closed) close(way, cells, link.cell);
    add(way, cells, closed);
  }

  // Ends the way where it began, with whole cells: it begins where one cell ends and another begins.
  static void close(std::vector<std::uint32_t>& way, std::vector<std::uint32_t>& cells,
                    std::uint32_t last_cell) {
    cells.push_back(last_cell);
    std::size_t shift = 0;
    while (shift < cells.size() && cells[shift] == cells.back()) ++shift;
    if (shift == cells.size()) shift = 0;
    std::rotate(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(shift), way.end());
    std::rotate(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(shift), cells.end());
    way.push_back(way.front());
  }

  void add(const std::vector<std::uint32_t>& way, const std::vector<std::uint32_t>& cells, bool closed) {
    RidgeCurve curve;
    curve.closed = closed;
    for (std::size_t first = 0, last; first < cells.size(); first = last) {
      for (last = first + 1; last < cells.size() && cells[last] == cells[first];) ++last;
      const std::span<const std::uint32_t> within(way.data() + first, last - first + 1);
      SheetVertex vertex = points_[within[0]].at;
      for (std::size_t n = 1; n < within.size(); ++n)
        vertex = between(vertex, points_[within[n]].at, 1 / static_cast<double>(n + 1));
      curve.vertices.push_back(vertex);
      curve.cells.push_back(cells[first]);
    }
    if (curve.vertices.size() >= (closed ? 3U : 2U)) curves_.push_back(std::move(curve));
  }

  const std::vector<CurvePoint>& points_;
  std::vector<char> passed_;
  std::vector<RidgeCurve> curves_;
};

}  // namespace

std::vector<RidgeCurve> ridge_curves(const Lattice& lattice, const RidgeValues& values,
                                     ExecutionContext* context) {
  const std::vector<CurvePoint> points = CurveFinder(lattice, values).run(context);
  return CurveTracer(points).run();
}

}  // namespace affskel::core
