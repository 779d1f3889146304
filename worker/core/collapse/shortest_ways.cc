#include "core/collapse/shortest_ways.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/bucket_queue.h"

namespace affskel::core {

std::vector<float> shortest_ways(const DualComplex& complex, std::span<const Anchor> anchors,
                                 std::span<const float> cost, ExecutionContext* context, float longest) {
  static const std::array<float, 4> kLength{0, 1, std::sqrt(2.0F), std::sqrt(3.0F)};
  constexpr float kBuckets = 8;  // per spacing of cost 1
  std::vector<float> way(complex.cubes(), kNoWay);
  BucketQueue<std::pair<float, std::uint32_t>> front;
  for (const Anchor& anchor : anchors) {
    for (const auto& member : complex.star(anchor.cell)) {
      if (way[member.cube] == 0) continue;
      way[member.cube] = 0;
      front.push(0, {0.0F, member.cube});
    }
  }
  const auto cost_at = [&](std::uint32_t cube) { return cost.empty() ? 1.0F : cost[cube]; };
  StopCheck stop(context);
  for (std::pair<float, std::uint32_t> at; front.pop(at); stop.did(100)) {
    const auto [reached, cube] = at;
    if (reached > way[cube]) continue;
    complex.for_each_step(cube, [&](std::uint32_t to, std::uint32_t steps) {
      const float there = reached + 0.5F * (cost_at(cube) + cost_at(to)) * kLength[steps];
      if (there >= way[to] || there > longest) return;
      way[to] = there;
      front.push(static_cast<std::size_t>(there * kBuckets), {there, to});
    });
  }
  return way;
}

}  // namespace affskel::core
