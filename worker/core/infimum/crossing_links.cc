#include "core/infimum/crossing_links.h"

#include <algorithm>

namespace affskel::core {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

class Linking {
 public:
  Linking(const Mesh& mesh, const HalfEdges& mates, std::vector<Pair> pairs)
      : mesh_(mesh), mates_(mates), linked_(pairs.size()), pairs_(std::move(pairs)) {
    for (auto& [i, j] : pairs_) {
      if (j < i) std::swap(i, j);
    }
    std::ranges::sort(pairs_);
  }

  std::vector<CrossingPair> run() {
    std::vector<std::uint32_t> line;
    for (std::uint32_t n = 0; n < pairs_.size(); ++n) {
      if (is_linked(n)) continue;
      begin_line(n);
      line.assign(1, n);
      for (std::size_t i = 0; i < line.size(); ++i) go_on(line[i], line);
    }
    return std::move(linked_);
  }

 private:
  bool is_linked(std::uint32_t n) const { return linked_[n].first != linked_[n].second; }

  void begin_line(std::uint32_t n) {
    const auto& [i, j] = pairs_[n];
    linked_[n] = {i, j, {kNone, kNone}};
    const Triangle &a = mesh_.triangles[i], &b = mesh_.triangles[j];
    const auto shared = std::ranges::find_first_of(a, b);
    if (shared != a.end()) linked_[n].links.fill(*shared);
  }

  // To the pairs of which a triangle is next to one of this pair's.
  void go_on(std::uint32_t n, std::vector<std::uint32_t>& line) {
    const auto& [i, j] = pairs_[n];
    for (std::uint32_t k = 0; k < 3; ++k) {
      link(j, 3 * i + k, line);
      link(i, 3 * j + k, line);
    }
  }

  void link(std::uint32_t shared, std::uint32_t half_edge, std::vector<std::uint32_t>& line) {
    const std::uint32_t beyond = mates_[half_edge] / 3;
    const Pair next = std::minmax(shared, beyond);
    const auto at = std::ranges::lower_bound(pairs_, next);
    if (at == pairs_.end() || *at != next) return;
    const auto n = static_cast<std::uint32_t>(at - pairs_.begin());
    if (is_linked(n)) return;
    const Triangle& corners = mesh_.triangles[half_edge / 3];
    linked_[n] = {shared, beyond, {corners[half_edge % 3], corners[(half_edge + 1) % 3]}};
    line.push_back(n);
  }

  const Mesh& mesh_;
  const HalfEdges& mates_;
  std::vector<CrossingPair> linked_;  // those that are not yet, have the same triangle twice
  std::vector<Pair> pairs_;           // in order
};

}  // namespace

std::vector<CrossingPair> link_crossings(const Mesh& mesh, const HalfEdges& mates, std::vector<Pair> pairs) {
  return Linking(mesh, mates, std::move(pairs)).run();
}

}  // namespace affskel::core
