#include "core/mesh/close_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace affskel::core {
namespace {

// From here on a fan gets boxes of its own: below, comparing all its triangles costs less.
constexpr std::uint32_t kLargeFan = 64;

constexpr double kEps = std::numeric_limits<double>::epsilon();

Box around(const Vec3& a, const Vec3& b) {
  return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
          {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

Box widened(Box box, double by) {
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] -= by;
    box.high[k] += by;
  }
  return box;
}

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// Holds the arc that side pq draws on the unit sphere round v.  The arc lies within its rise of the chord.
// Two triangles pqv and rsv, each with an area, have more in common than v only if their arcs meet.
Box arc_box(const Vec3& v, const Vec3& p, const Vec3& q) {
  const Box everything = {{-1, -1, -1}, {1, 1, 1}};
  const Vec3 to_p = p - v, to_q = q - v;
  const double size_p = largest(to_p), size_q = largest(to_q);
  if (!(size_p > 0 && size_q > 0 && std::isfinite(size_p) && std::isfinite(size_q))) return everything;
  // The largest component first: squares must not leave the range of a double.
  const Vec3 a = {to_p.x / size_p, to_p.y / size_p, to_p.z / size_p};
  const Vec3 b = {to_q.x / size_q, to_q.y / size_q, to_q.z / size_q};
  const Vec3 unit_p = (1 / norm(a)) * a, unit_q = (1 / norm(b)) * b;
  const double rise = 1 - norm(0.5 * (unit_p + unit_q));
  return widened(around(unit_p, unit_q), rise + 16 * kEps);
}

// Boxes that cover the triangle v, p, q: of its parts from v half of the way to the side pq, half of the
// rest, and so on, until a part is about as long as the side.
void append_pieces(const Vec3& v, const Vec3& p, const Vec3& q, const Box& whole, std::vector<Box>& pieces) {
  constexpr int kMost = 30;
  const double length = std::max(largest(p - v), largest(q - v)), width = largest(q - p);
  // What the rounding of a point between v and p or q may come to.
  const double margin = 4 * kEps * std::max({largest(v), largest(p), largest(q)}) +
                        4 * std::numeric_limits<double>::denorm_min();
  Vec3 p_before = v, q_before = v;
  double rest = 1;
  for (int k = 0; k < kMost && rest * length > 2 * width; ++k) {
    rest /= 2;
    const Vec3 p_next = rest * v + (1 - rest) * p, q_next = rest * v + (1 - rest) * q;
    Box piece = around(p_before, q_before);
    piece.include(around(p_next, q_next));
    piece = widened(piece, margin);
    for (std::size_t c = 0; c < 3; ++c) {
      piece.low[c] = std::max(piece.low[c], whole.low[c]);
      piece.high[c] = std::min(piece.high[c], whole.high[c]);
    }
    pieces.push_back(piece);
    p_before = p_next;
    q_before = q_next;
  }
  Box last = widened(around(p_before, q_before), margin);
  last.include(around(p, q));
  pieces.push_back(last);
}

// The corners of a triangle of the fan, the fan's vertex first.
Triangle from_vertex(const Triangle& t, std::uint32_t vertex) {
  if (t[1] == vertex) return {t[1], t[2], t[0]};
  return t[2] == vertex ? Triangle{t[2], t[0], t[1]} : t;
}

}  // namespace

std::uint32_t CloseTriangles::Members::behind(std::uint32_t i) const {
  return static_cast<std::uint32_t>(std::upper_bound(index.begin(), index.end(), i) - index.begin());
}

CloseTriangles::CloseTriangles(const Mesh& mesh, const std::vector<Box>& boxes, unsigned threads)
    : boxes_(boxes) {
  assign_fans(mesh);
  if (fans_.empty()) {
    loose_.tree = BoxTree(boxes, threads);
    return;
  }
  std::vector<Box> loose, whole;
  for (const std::uint32_t t : loose_.members.index) loose.push_back(boxes[t]);
  loose_.tree = BoxTree(std::move(loose), threads);
  for (Fan& fan : fans_) {
    cut(mesh, fan, threads);
    whole.push_back(boxes[fan.members.index.front()]);
    for (const std::uint32_t t : fan.members.index) whole.back().include(boxes[t]);
  }
  fan_tree_ = BoxTree(std::move(whole), threads);
}

// Each triangle goes to the largest of the large fans at its corners.  What it then has to do with a smaller
// fan at another corner is found triangle by triangle: of two neighbouring vertices, the lesser number of
// triangles counts, and in a surface like a sphere's these sum to O(N) (Chiba and Nishizeki 1985).
void CloseTriangles::assign_fans(const Mesh& mesh) {
  std::vector<std::uint32_t> valence(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++valence[v];
  }
  if (std::none_of(valence.begin(), valence.end(), [](std::uint32_t n) { return n > kLargeFan; })) return;
  fan_of_.assign(mesh.triangles.size(), kNone);
  std::map<std::uint32_t, std::uint32_t> fan_at;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const std::uint32_t home = *std::max_element(t.begin(), t.end(), [&](std::uint32_t v, std::uint32_t w) {
      return std::pair(valence[v], w) < std::pair(valence[w], v);
    });
    if (valence[home] <= kLargeFan) {
      loose_.members.index.push_back(i);
      continue;
    }
    const auto [place, added] = fan_at.emplace(home, static_cast<std::uint32_t>(fans_.size()));
    if (added) fans_.emplace_back().vertex = home;
    fan_of_[i] = place->second;
    fans_[place->second].members.index.push_back(i);
  }
}

void CloseTriangles::cut(const Mesh& mesh, Fan& fan, unsigned threads) const {
  for (std::uint32_t local = 0; local < fan.members.index.size(); ++local) {
    const std::uint32_t i = fan.members.index[local];
    const Triangle t = from_vertex(mesh.triangles[i], fan.vertex);
    const Vec3 &v = mesh.points[t[0]], &p = mesh.points[t[1]], &q = mesh.points[t[2]];
    fan.arcs.push_back(arc_box(v, p, q));
    fan.first_piece.push_back(static_cast<std::uint32_t>(fan.pieces.size()));
    append_pieces(v, p, q, boxes_[i], fan.pieces);
    fan.piece_member.resize(fan.pieces.size(), local);
  }
  fan.first_piece.push_back(static_cast<std::uint32_t>(fan.pieces.size()));
  fan.arc_tree = BoxTree(fan.arcs, threads);
  fan.piece_tree = BoxTree(fan.pieces, threads);
}

}  // namespace affskel::core
