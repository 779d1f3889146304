#include "core/collapse/realms.h"

#include <algorithm>
#include <cstddef>

#include "core/base/bucket_queue.h"
#include "core/collapse/shortest_ways.h"

namespace affskel::core {

std::vector<std::uint32_t> realms(const DualComplex& complex, std::span<const RealmSeed> seeds,
                                  ExecutionContext* context) {
  constexpr float kBuckets = 8;  // per step
  struct Step {
    float way = 0;  // steps, from the smallest ball
    std::uint32_t cube = 0, seed = 0;
  };
  std::vector<float> way(complex.cubes(), kNoWay);
  std::vector<std::uint32_t> realm(complex.cubes(), kNone);
  float greatest = 0;
  for (const RealmSeed& seed : seeds) greatest = std::max(greatest, seed.radius);
  BucketQueue<Step> front;
  const auto reach = [&](std::uint32_t cube, float there, std::uint32_t seed) {
    if (there >= way[cube]) return;
    way[cube] = there;
    front.push(static_cast<std::size_t>(there * kBuckets), {there, cube, seed});
  };
  for (std::uint32_t n = 0; n < seeds.size(); ++n) reach(seeds[n].cube, greatest - seeds[n].radius, n);
  StopCheck stop(context);
  for (Step at; front.pop(at); stop.did(100)) {
    if (at.way > way[at.cube]) continue;  // another is nearer
    realm[at.cube] = at.seed;
    complex.for_each_step(at.cube, [&](std::uint32_t to, std::uint32_t steps) {
      reach(to, at.way + kStepLength[steps], at.seed);
    });
  }
  return realm;
}

}  // namespace affskel::core
