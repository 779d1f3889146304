#include "core/collapse/shortest_ways.h"

#include <queue>
#include <unordered_map>
#include <utility>

#include "core/base/bucket_queue.h"

namespace affskel::core {

CellSet closure_of(const DualComplex& complex, std::span<const Anchor> anchors) {
  CellSet closure(complex);
  for (const Anchor& anchor : anchors) insert_closed(complex, anchor.cell, closure);
  return closure;
}

std::vector<float> shortest_ways(const DualComplex& complex, std::span<const Anchor> anchors,
                                 std::span<const float> cost, ExecutionContext* context) {
  constexpr float kBuckets = 8;  // per spacing of cost 1
  std::vector<float> way(complex.cubes(), kNoWay);
  const auto cost_at = [&](std::uint32_t cube) { return cost.empty() ? 1.0F : cost[cube]; };
  StopCheck stop(context);
  for (const bool from_ends : {false, true}) {
    BucketQueue<std::pair<float, std::uint32_t>> front;
    for (const Anchor& anchor : anchors) {
      if (anchor.is_end != from_ends) continue;
      for (const auto& member : complex.star(anchor.cell)) {
        if (way[member.cube] != kNoWay) continue;
        way[member.cube] = 0;
        front.push(0, {0.0F, member.cube});
      }
    }
    for (std::pair<float, std::uint32_t> at; front.pop(at); stop.did(100)) {
      const float reached = at.first;
      const std::uint32_t cube = at.second;
      if (reached > way[cube]) continue;
      const float cost_here = cost_at(cube);
      complex.for_each_step(cube, [&](std::uint32_t to, std::uint32_t steps) {
        const float there = reached + 0.5F * (cost_here + cost_at(to)) * kStepLength[steps];
        if (there >= way[to]) return;
        way[to] = there;
        front.push(static_cast<std::size_t>(there * kBuckets), {there, to});
      });
    }
  }
  return way;
}

bool is_near(const DualComplex& complex, DualComplex::Cell from, float longest,
             const std::function<bool(std::uint32_t cube, float way)>& wanted) {
  std::unordered_map<std::uint32_t, float> way;
  using Item = std::pair<float, std::uint32_t>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> front;
  for (const auto& member : complex.star(from))
    if (way.emplace(member.cube, 0.0F).second) front.push({0.0F, member.cube});
  while (!front.empty()) {
    const float reached = front.top().first;
    const std::uint32_t cube = front.top().second;
    front.pop();
    if (wanted(cube, reached)) return true;
    if (reached > way[cube]) continue;
    complex.for_each_step(cube, [&](std::uint32_t to, std::uint32_t steps) {
      const float there = reached + kStepLength[steps];
      if (there > longest) return;
      const auto [known, fresh] = way.try_emplace(to, there);
      if (!fresh && there >= known->second) return;
      known->second = there;
      front.push({there, to});
    });
  }
  return false;
}

}  // namespace affskel::core
