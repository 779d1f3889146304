#include "core/solid/copies.h"

#include <bit>
#include <map>

#include "core/base/split_mix64.h"

namespace affskel::core {
namespace {

// Of a place; 0 and -0 are the same.
std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t hash = 0;
  for (const double x : {p.x, p.y, p.z})
    hash = SplitMix64(hash ^ std::bit_cast<std::uint64_t>(x + 0.0)).next();
  return hash;
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> copied_shells(const Solid& solid) {
  // The sum of what a shell's corners hash to, whatever their order.
  std::vector<std::uint64_t> sums(solid.shells.size(), 0);
  for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t)
    for (const std::uint32_t v : solid.mesh.triangles[t])
      sums[solid.triangle_shell[t]] += hash_of(solid.mesh.points[v]);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> copies;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t> first;
  for (std::uint32_t s = 0; s < solid.shells.size(); ++s) {
    const auto [known, is_new] = first.try_emplace({solid.shells[s].triangles, sums[s]}, s);
    if (!is_new) copies.emplace_back(known->second, s);
  }
  return copies;
}

}  // namespace affskel::core
