#include "core/infimum/crossing_pairs.h"

#include <algorithm>
#include <utility>

#include "core/mesh/box.h"

namespace affskel::core {
namespace {

// Vertices that are looked at for a way between two triangles: of others planes are always asked.
constexpr std::size_t kMostOnWay = 256;

class PairBoxes {
 public:
  PairBoxes(const Mesh& mesh, const Groups<std::uint32_t>& rings)
      : mesh_(mesh), rings_(rings), everything_(box_of(mesh)), from_(mesh.points.size(), kNone) {}

  // A pair tells something new only where the plane parts its second triangle, of which the links lie above; one
  // without links, where it passes between its triangles.
  Box of(const CrossingPair& pair) {
    const Triangle &first = mesh_.triangles[pair.first], &second = mesh_.triangles[pair.second];
    Box box = box_of(mesh_, second);
    if (pair.links[0] != kNone) return box;
    box.include(box_of(mesh_, first));
    return add_way(first, second, box) ? box : everything_;
  }

 private:
  // Adds the corners of a way along edges between two triangles; false where none is found.
  bool add_way(const Triangle& first, const Triangle& second, Box& box) {
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
    for (std::uint32_t v = met; v != kNone && from_[v] != v; v = from_[v]) box.include(mesh_.points[v]);
    for (const std::uint32_t v : seen) from_[v] = kNone;
    return met != kNone;
  }

  const Mesh& mesh_;
  const Groups<std::uint32_t>& rings_;
  const Box everything_;
  std::vector<std::uint32_t> from_;  // per vertex: the one before it on the ways in hand
};

}  // namespace

CrossingPairs::CrossingPairs(const Mesh& mesh, const Groups<std::uint32_t>& rings,
                             std::vector<CrossingPair> pairs)
    : pairs_(std::move(pairs)) {
  if (pairs_.empty()) return;
  PairBoxes round(mesh, rings);
  std::vector<Box> boxes;
  for (const CrossingPair& pair : pairs_) boxes.push_back(round.of(pair));
  tree_.build(boxes);
  at_ = {mesh.points.size(), [&](const auto& put) {
           for (const CrossingPair& pair : pairs_) {
             for (const std::uint32_t v : mesh.triangles[pair.first])
               put(v, Crossing{pair.first, pair.second});
             for (const std::uint32_t v : mesh.triangles[pair.second])
               put(v, Crossing{pair.second, pair.first});
           }
         }};
}

}  // namespace affskel::core
