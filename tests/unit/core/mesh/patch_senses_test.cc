#include "core/mesh/patch_senses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

void turn_some(std::vector<Triangle>& triangles, std::uint64_t seed) {
  SplitMix64 random(seed);
  for (Triangle& t : triangles)
    if (random.next() % 2 == 0) std::swap(t[1], t[2]);
}

// How many edges of exactly two triangles both run along in one sense.
std::size_t disagreements(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::size_t, 2>> along;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      ++along[std::minmax(t[k], t[(k + 1) % 3])][t[k] < t[(k + 1) % 3] ? 0 : 1];
  return static_cast<std::size_t>(std::count_if(along.begin(), along.end(), [](const auto& edge) {
    const auto& [up, down] = edge.second;
    return up + down == 2 && up != 1;
  }));
}

// Two tori and a sheet that hangs on one of their edges.
TEST(PatchSenses, AgreeOnSurfacesWithTwoSides) {
  Mesh mesh = make_torus(3, 1, 512);
  const auto more = static_cast<std::uint32_t>(mesh.points.size());
  for (const Triangle& t : make_torus(3, 1, 512).triangles)
    mesh.triangles.push_back({t[0] + more, t[1] + more, t[2] + more});
  const Triangle at = mesh.triangles[0];
  mesh.triangles.push_back({at[0], at[1], 2 * more});
  mesh.triangles.push_back({at[1], at[0], 2 * more + 1});
  const std::vector<Triangle> before = mesh.triangles;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    turn_some(mesh.triangles, seed);
    const Triangle first = mesh.triangles[0];
    EXPECT_GT(disagreements(mesh.triangles), 0U);
    agree_on_senses(2 * more + 2, mesh.triangles);
    EXPECT_EQ(disagreements(mesh.triangles), 0U);
    EXPECT_EQ(mesh.triangles[0], first);
    for (std::size_t t = 0; t < before.size(); ++t) {
      Triangle a = before[t], b = mesh.triangles[t];
      std::sort(a.begin(), a.end());
      std::sort(b.begin(), b.end());
      EXPECT_EQ(a, b) << t;
    }
  }
}

// A band of ten triangles: a Moebius strip disagrees along one edge.
TEST(PatchSenses, LeaveOneSidedSurfacesOneDisagreement) {
  std::vector<Triangle> triangles;
  for (std::uint32_t k = 0; k < 5; ++k) {
    const std::uint32_t a = 2 * k, b = a + 1;
    const std::uint32_t c = k < 4 ? a + 2 : 1, d = k < 4 ? a + 3 : 0;
    triangles.push_back({a, b, c});
    triangles.push_back({b, d, c});
  }
  turn_some(triangles, 1);
  agree_on_senses(10, triangles);
  EXPECT_EQ(disagreements(triangles), 1U);
}

}  // namespace
}  // namespace affskel::core
