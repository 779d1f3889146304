#include "core/collapse/realms.h"

#include <cstddef>

#include "core/base/bucket_queue.h"
#include "core/collapse/shortest_ways.h"

namespace affskel::core {

std::vector<std::uint32_t> realms(const DualComplex& complex, std::span<const RealmSeed> seeds,
                                  ExecutionContext* context) {
  constexpr float kBuckets = 64;  // per radius
  struct Step {
    float way = 0;  // radii
    std::uint32_t cube = 0, seed = 0;
  };
  std::vector<float> way(complex.cubes(), kNoWay);
  std::vector<std::uint32_t> realm(complex.cubes(), DualComplex::kNone);
  BucketQueue<Step> front;
  for (std::uint32_t n = 0; n < seeds.size(); ++n) {
    if (way[seeds[n].cube] == 0) continue;
    way[seeds[n].cube] = 0;
    front.push(0, {0, seeds[n].cube, n});
  }
  StopCheck stop(context);
  for (Step at; front.pop(at); stop.did(100)) {
    if (realm[at.cube] != DualComplex::kNone) continue;
    realm[at.cube] = at.seed;
    complex.for_each_step(at.cube, [&](std::uint32_t to, std::uint32_t steps) {
      const float there = at.way + kStepLength[steps] / seeds[at.seed].radius;
      if (there >= way[to]) return;
      way[to] = there;
      front.push(static_cast<std::size_t>(there * kBuckets), {there, to, at.seed});
    });
  }
  return realm;
}

}  // namespace affskel::core
