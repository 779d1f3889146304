#include "core/ridge/surface_squares.h"

#include <algorithm>
#include <utility>

#include "core/base/cheapest_ways.h"
#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/base/unit.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

// Where the solid grows thinner outwards ways there are longer, by up to this, squares: closing would move rims out.
constexpr double kStep = 1.5;

// Of several squares at an edge those below so many times `low` stand on the others.  Of 1, 1.5 and 2 this left the fewest
// edges with three squares in twelve bodies: 74, 30, 44.
constexpr double kStanding = 1.5;

class Selection {
 public:
  Selection(const CrossedSquares& squares, double low)
      : squares_(squares), low_(low), count_(squares.cells.ring.size()) {
    for (std::uint32_t square = 0; square < count_; ++square) {
      const auto& ring = squares.cells.ring[square];
      for (std::size_t k = 0; k < 4; ++k) {
        const auto [a, b] = std::minmax(ring[k], ring[(k + 1) % 4]);
        sides_.push_back({a, b, square});
      }
    }
    std::sort(sides_.begin(), sides_.end());
  }

  SurfaceSquares run(double gap) {
    take_strong();
    leave_out_standing();
    close_gaps(gap);
    std::vector<std::uint32_t> piece = pieces();
    return {std::move(taken_), std::move(piece)};
  }

 private:
  struct Side {
    std::uint32_t low, high, square;
    auto operator<=>(const Side&) const = default;
  };

  bool is_strong(std::uint32_t vertex) const { return squares_.vertices[vertex].strength >= low_; }
  bool is_strong(const Side& side) const { return is_strong(side.low) || is_strong(side.high); }

  // For each edge, use(its sides).
  template <class Use>
  void for_each_edge(const Use& use) const {
    const auto apart = [](const Side& a, const Side& b) { return a.low != b.low || a.high != b.high; };
    for (auto first = sides_.begin(), last = first; first != sides_.end(); first = last) {
      last = std::adjacent_find(first, sides_.end(), apart);
      if (last != sides_.end()) ++last;
      use(std::span<const Side>(first, last));
    }
  }

  void take_strong() {
    taken_.resize(count_);
    std::transform(
        squares_.cells.ring.begin(), squares_.cells.ring.end(), taken_.begin(), [&](const auto& ring) {
          return std::any_of(ring.begin(), ring.end(), [&](std::uint32_t v) { return is_strong(v); });
        });
  }

  void leave_out_standing() {
    for_each_edge([&](std::span<const Side> sides) {
      if (sides.size() <= 2) return;
      for (const Side& side : sides)
        if (squares_.strength[side.square] < kStanding * low_) taken_[side.square] = 0;
    });
  }

  // Ways, in radii, lead over edges of two squares; at others the surface ends.
  void close_gaps(double gap) {
    std::vector<char> ends(count_, 0);
    std::vector<Segment> pairs;
    for_each_edge([&](std::span<const Side> sides) {
      if (sides.size() == 2)
        pairs.push_back({sides[0].square, sides[1].square});
      else
        for (const Side& side : sides) ends[side.square] = 1;
    });
    const Adjacency beside = neighbours(count_, pairs);
    const auto ways_from = [&](const auto& is_source) {
      std::vector<std::uint32_t> sources(count_, kNone);
      for (std::uint32_t square = 0; square < count_; ++square)
        if (is_source(square)) sources[square] = 0;
      CheapestWays ways(std::move(sources));
      ways.find([&](std::uint32_t square, const auto& go) {
        for (const std::uint32_t to : beside[square])
          go(to, 0.5 / squares_.radius[square] + 0.5 / squares_.radius[to], square);
      });
      return std::move(ways.cost);
    };
    const std::vector<double> from_taken =
        ways_from([&](std::uint32_t square) { return taken_[square] != 0; });
    const std::vector<double> from_beyond =
        ways_from([&](std::uint32_t square) { return ends[square] != 0 || from_taken[square] > gap; });
    closes_.assign(count_, 0);
    for (std::uint32_t square = 0; square < count_; ++square) {
      closes_[square] = !taken_[square] && from_beyond[square] > gap + kStep / squares_.radius[square];
      if (closes_[square]) taken_[square] = 1;
    }
  }

  std::vector<std::uint32_t> pieces() const {
    DisjointSets joined(count_);
    for_each_edge([&](std::span<const Side> sides) {
      const auto [a, b] = continued(sides);
      if (a != b && (is_strong(sides[0]) || closes_[a] || closes_[b])) joined.unite(a, b);
    });
    std::vector<std::uint32_t> piece(count_);
    for (std::uint32_t square = 0; square < count_; ++square) piece[square] = joined.find(square);
    return piece;
  }

  // Of the squares at an edge that are taken the two that go on in each other, straightest; a square twice where it is alone.
  std::pair<std::uint32_t, std::uint32_t> continued(std::span<const Side> sides) const {
    std::pair<std::uint32_t, std::uint32_t> best{sides[0].square, sides[0].square};
    double least = 2;
    for (std::size_t m = 0; m < sides.size(); ++m)
      for (std::size_t n = m + 1; n < sides.size(); ++n) {
        if (!taken_[sides[m].square] || !taken_[sides[n].square]) continue;
        const double bend = dot(away(sides[m]), away(sides[n]));
        if (bend >= least) continue;
        least = bend;
        best = {sides[m].square, sides[n].square};
      }
    return best;
  }

  // From its edge to a square.
  Vec3 away(const Side& side) const {
    const Vec3& a = squares_.vertices[side.low].position;
    const Vec3& b = squares_.vertices[side.high].position;
    Vec3 middle;
    for (const std::uint32_t v : squares_.cells.ring[side.square])
      middle = middle + 0.25 * squares_.vertices[v].position;
    const Vec3 along = unit(b - a), way = middle - 0.5 * (a + b);
    return unit(way - dot(way, along) * along);
  }

  const CrossedSquares& squares_;
  double low_;
  std::size_t count_;
  std::vector<Side> sides_;           // of all squares, by edge
  std::vector<char> taken_, closes_;  // per square
};

}  // namespace

SurfaceSquares surface_squares(const CrossedSquares& squares, double low, double gap) {
  return Selection(squares, low).run(gap);
}

}  // namespace affskel::core
