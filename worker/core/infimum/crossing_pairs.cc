// What tells of a pair that its parts are joined already.  Pairs follow one another along the line in which surfaces
// pass through each other: the next one shares a triangle, and its other one is next to the other, across an edge.
// The edge's ends are the pair's vertices: where one of them lies below and the shared triangle has begun, what the
// pair before it joins is joined, and has that end.  So it tells something new only where the plane parts the triangle
// beyond the edge, which is in its box.  The first pair of a line has the corner that both share, if there is one, and
// either one's box; else its box holds both, and a way along edges from one to the other.
#include "core/infimum/crossing_pairs.h"

#include <algorithm>
#include <utility>

#include "core/mesh/box.h"

namespace affskel::core {
namespace {

// Vertices that are looked at for a way between two triangles: of others the plane is always asked.
constexpr std::size_t kMostOnWay = 256;

class PairLines {
 public:
  PairLines(const Mesh& mesh, std::span<const std::uint32_t> mates, const Groups<std::uint32_t>& rings,
            std::span<const CrossingPairs::Pair> pairs)
      : mesh_(mesh),
        mates_(mates),
        rings_(rings),
        pairs_(pairs),
        everything_(box_of(mesh)),
        from_(mesh.points.size(), kNone),
        boxes_(pairs.size()),
        links_(pairs.size(), {kNone, kNone}) {
    std::vector<std::uint8_t> reached(pairs.size(), 0);
    std::vector<std::uint32_t> line;
    for (std::uint32_t n = 0; n < pairs.size(); ++n) {
      if (reached[n] != 0) continue;
      reached[n] = 1;
      begin_line(n);
      line.assign(1, n);
      for (std::size_t i = 0; i < line.size(); ++i) {
        for_each_next(line[i], [&](std::uint32_t next, std::uint32_t half_edge) {
          if (reached[next] != 0) return;
          reached[next] = 1;
          boxes_[next] = round(mates[half_edge] / 3);
          links_[next] = {corner(half_edge), corner(half_edge / 3 * 3 + (half_edge + 1) % 3)};
          line.push_back(next);
        });
      }
    }
  }

  const std::vector<Box>& boxes() const { return boxes_; }
  std::vector<std::array<std::uint32_t, 2>>& links() { return links_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  std::uint32_t corner(std::uint32_t half_edge) const {
    return mesh_.triangles[half_edge / 3][half_edge % 3];
  }

  Box round(std::uint32_t triangle) const { return box_of(mesh_, mesh_.triangles[triangle]); }

  // Calls visit(pair, half-edge) for those of which a triangle is across that half-edge.
  template <class Visit>
  void for_each_next(std::uint32_t n, Visit visit) const {
    const CrossingPairs::Pair& pair = pairs_[n];
    const auto ask = [&](std::uint32_t half_edge, std::uint32_t shared) {
      const std::uint32_t beyond = mates_[half_edge] / 3;
      const CrossingPairs::Pair next = {std::min(beyond, shared), std::max(beyond, shared)};
      const auto at = std::ranges::lower_bound(pairs_, next);
      if (at != pairs_.end() && *at == next)
        visit(static_cast<std::uint32_t>(at - pairs_.begin()), half_edge);
    };
    for (std::uint32_t k = 0; k < 3; ++k) {
      ask(3 * pair.first + k, pair.second);
      ask(3 * pair.second + k, pair.first);
    }
  }

  void begin_line(std::uint32_t n) {
    boxes_[n] = round(pairs_[n].first);
    const Triangle &first = mesh_.triangles[pairs_[n].first], &second = mesh_.triangles[pairs_[n].second];
    const auto shared = std::ranges::find_first_of(first, second);
    if (shared != first.end()) {
      links_[n] = {*shared, *shared};
    } else {
      boxes_[n].include(round(pairs_[n].second));
      add_way(first, second, boxes_[n]);
    }
  }

  // Adds the corners of a way along edges between two triangles to the box.
  void add_way(const Triangle& first, const Triangle& second, Box& box) {
    std::vector<std::uint32_t> seen(first.begin(), first.end());
    for (const std::uint32_t v : seen) from_[v] = v;
    std::uint32_t met = kNone;
    for (std::size_t i = 0; i < seen.size() && met == kNone; ++i) {
      if (std::ranges::find(second, seen[i]) != second.end()) met = seen[i];
      if (seen.size() >= kMostOnWay) continue;
      for (const std::uint32_t next : rings_[seen[i]]) {
        if (from_[next] != kNone) continue;
        from_[next] = seen[i];
        seen.push_back(next);
      }
    }
    if (met == kNone) {
      box = everything_;
    } else {
      for (; from_[met] != met; met = from_[met]) box.include(mesh_.points[met]);
    }
    for (const std::uint32_t v : seen) from_[v] = kNone;
  }

  const Mesh& mesh_;
  std::span<const std::uint32_t> mates_;
  const Groups<std::uint32_t>& rings_;
  std::span<const CrossingPairs::Pair> pairs_;  // in order
  const Box everything_;
  std::vector<std::uint32_t> from_;  // per vertex: the one before it on the ways in hand
  std::vector<Box> boxes_;
  std::vector<std::array<std::uint32_t, 2>> links_;
};

}  // namespace

CrossingPairs::CrossingPairs(const Mesh& mesh, std::span<const std::uint32_t> mates,
                             const Groups<std::uint32_t>& rings, std::vector<Pair> pairs)
    : pairs_(std::move(pairs)) {
  if (pairs_.empty()) return;
  for (Pair& pair : pairs_) {
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
  }
  std::ranges::sort(pairs_);
  PairLines lines(mesh, mates, rings, pairs_);
  links_ = std::move(lines.links());
  tree_.build(lines.boxes());
  at_ = {mesh.points.size(), [&](const auto& put) {
           for (const Pair& pair : pairs_) {
             for (const std::uint32_t v : mesh.triangles[pair.first]) put(v, pair);
             for (const std::uint32_t v : mesh.triangles[pair.second]) put(v, Pair{pair.second, pair.first});
           }
         }};
}

}  // namespace affskel::core
