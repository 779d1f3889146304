#include "core/mesh/quad_diagonals.h"

#include <algorithm>
#include <map>

namespace affskel::core {
namespace {

// How a diagonal comes to be an edge elsewhere: two quadrilaterals over the same two edges may both be cut
// along the line between the edges' ends, and so hold one triangle twice; or the diagonal is the edge of two
// triangles of other faces.  The surface then seems not to bound a solid, though its polygons do.

/// A quadrilateral tip, from, far, to (in this sense), cut along from-to.
struct Quad {
  std::uint32_t tip, from, far, to;
};

Quad quad_of(const Triangle& first, const Triangle& second) {
  std::size_t tip = 0;
  while (tip < 2 && uses(second, first[tip])) ++tip;
  std::size_t far = 0;
  while (far < 2 && uses(first, second[far])) ++far;
  return {first[tip], first[(tip + 1) % 3], second[far], first[(tip + 2) % 3]};
}

/// How many triangles have an edge, as diagonals are turned.
class EdgeUse {
 public:
  explicit EdgeUse(std::span<const Triangle> triangles) {
    edges_.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
      for (std::size_t k = 0; k < 3; ++k) edges_.push_back(ascending(t[k], t[(k + 1) % 3]));
    }
    std::sort(edges_.begin(), edges_.end());
  }

  std::ptrdiff_t of(const Segment& edge) const {
    const auto [first, last] = std::equal_range(edges_.begin(), edges_.end(), edge);
    const auto change = changes_.find(edge);
    return last - first + (change == changes_.end() ? 0 : change->second);
  }
  void move(const Segment& from, const Segment& to) {
    changes_[from] -= 2;
    changes_[to] += 2;
  }

 private:
  std::vector<Segment> edges_;
  std::map<Segment, std::ptrdiff_t> changes_;
};

}  // namespace

std::size_t turn_doubled_diagonals(std::span<const std::uint32_t> quads, std::vector<Triangle>& triangles) {
  if (quads.empty()) return 0;
  EdgeUse use(triangles);
  std::size_t turned = 0;
  for (const std::uint32_t i : quads) {
    const Quad q = quad_of(triangles[i], triangles[i + 1]);
    const Segment diagonal = ascending(q.from, q.to), other = ascending(q.tip, q.far);
    if (use.of(diagonal) <= 2 || use.of(other) != 0) continue;
    triangles[i] = {q.tip, q.from, q.far};
    triangles[i + 1] = {q.far, q.to, q.tip};
    use.move(diagonal, other);
    ++turned;
  }
  return turned;
}

}  // namespace affskel::core
