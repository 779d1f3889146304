#include "core/curve/volume_beyond.h"

#include <algorithm>
#include <cstdint>

#include "core/base/none.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

// A search in depth, without recursion: low is the earliest vertex that a subtree has an edge to.
class Cuts {
 public:
  Cuts(std::span<const Segment> segments, std::span<const double> weight)
      : weight_(weight),
        neighbours_(neighbours(weight.size(), segments)),
        order_(weight.size(), kNone),
        low_(weight.size(), 0),
        parent_(weight.size(), kNone),
        below_(weight.begin(), weight.end()),
        parted_(weight.size(), 0),
        heaviest_(weight.size(), 0) {}

  std::vector<double> run() {
    std::vector<double> beyond(weight_.size(), 0);
    for (std::uint32_t root = 0; root < weight_.size(); ++root) {
      if (order_[root] != kNone) continue;
      const std::size_t first = found_.size();
      search(root);
      for (std::size_t n = first; n < found_.size(); ++n) {
        const std::uint32_t v = found_[n];
        const double rest = v == root ? 0 : below_[root] - parted_[v] - weight_[v];
        beyond[v] = parted_[v] + rest - std::max(heaviest_[v], rest) + 0.5 * weight_[v];
      }
    }
    return beyond;
  }

 private:
  void search(std::uint32_t root) {
    std::vector<std::pair<std::uint32_t, std::size_t>> way;
    const auto enter = [&](std::uint32_t v) {
      order_[v] = low_[v] = static_cast<std::uint32_t>(found_.size());
      found_.push_back(v);
      way.push_back({v, 0});
    };
    enter(root);
    while (!way.empty()) {
      const std::uint32_t v = way.back().first;
      const auto around = neighbours_[v];
      if (way.back().second < around.size()) {
        const std::uint32_t to = around[way.back().second++];
        if (order_[to] == kNone) {
          parent_[to] = v;
          enter(to);
        } else if (to != parent_[v]) {
          low_[v] = std::min(low_[v], order_[to]);
        }
        continue;
      }
      way.pop_back();
      if (parent_[v] != kNone) leave(v, parent_[v]);
    }
  }

  void leave(std::uint32_t child, std::uint32_t v) {
    low_[v] = std::min(low_[v], low_[child]);
    below_[v] += below_[child];
    if (low_[child] < order_[v]) return;  // hangs together with what lies above
    parted_[v] += below_[child];
    heaviest_[v] = std::max(heaviest_[v], below_[child]);
  }

  std::span<const double> weight_;
  Adjacency neighbours_;
  std::vector<std::uint32_t> order_, low_, parent_, found_;
  std::vector<double> below_;              // of the vertex and all that was found from it
  std::vector<double> parted_, heaviest_;  // of the subtrees that a cut parts: all, and the heaviest
};

}  // namespace

std::vector<double> volume_beyond(std::span<const Segment> segments, std::span<const double> weight) {
  return Cuts(segments, weight).run();
}

}  // namespace affskel::core
