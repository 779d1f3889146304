#include "core/mesh/edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <random>
#include <set>

#include "core/mesh/geodesic_sphere.h"

namespace affskel::core {
namespace {

constexpr std::size_t kPoints = 12;

// Open, crowded and doubled, turned at random.
std::vector<Triangle> random_triangles(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Triangle> triangles;
  while (triangles.size() < 30) {
    Triangle t{};
    for (std::uint32_t& corner : t) corner = static_cast<std::uint32_t>(random() % (kPoints - 1));
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

using Found = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>>;

Found by_map(const std::vector<Triangle>& triangles) {
  Found result;
  for (std::uint32_t h = 0; h < 3 * triangles.size(); ++h) {
    const Triangle& t = triangles[h / 3];
    result[std::minmax(t[h % 3], t[(h + 1) % 3])].push_back(h);
  }
  return result;
}

TEST(Edges, AreThoseOfAMapInItsOrder) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const std::vector<Triangle> triangles = random_triangles(seed);
    const Found expected = by_map(triangles);
    auto next = expected.begin();
    const Edges edges(kPoints, triangles);
    edges.for_each([&](std::uint32_t low, std::uint32_t high, std::span<const EdgeSide> sides) {
      ASSERT_NE(next, expected.end());
      EXPECT_EQ(std::pair(low, high), next->first);
      ASSERT_EQ(sides.size(), next->second.size());
      for (std::size_t n = 0; n < sides.size(); ++n) {
        EXPECT_EQ(sides[n].half_edge, next->second[n]);
        EXPECT_EQ(sides[n].triangle(), next->second[n] / 3);
        EXPECT_EQ(sides[n].high, high);
      }
      ++next;
    });
    EXPECT_EQ(next, expected.end());
    for (std::uint32_t a = 0; a < kPoints; ++a) {
      for (std::uint32_t b = 0; b < a; ++b) {
        const auto found = expected.find({b, a});
        EXPECT_EQ(edges.between(a, b).size(), found == expected.end() ? 0 : found->second.size());
        EXPECT_EQ(edges.between(a, b).data(), edges.between(b, a).data());
      }
    }
  }
}

TEST(Edges, AreTheSameOnSeveralThreads) {
  const Mesh sphere = geodesic_sphere(20);
  Found found;
  std::mutex mutex;
  Edges(sphere.points.size(), sphere.triangles, 4)
      .for_each(
          [&](std::uint32_t low, std::uint32_t high, std::span<const EdgeSide> sides) {
            const std::lock_guard guard(mutex);
            for (const EdgeSide& side : sides) found[{low, high}].push_back(side.half_edge);
          },
          4);
  EXPECT_EQ(found, by_map(sphere.triangles));
  EXPECT_EQ(found.size(), 30U * 20 * 20);
}

TEST(Neighbours, AndTrianglesAreThoseOfEveryVertex) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const std::vector<Triangle> triangles = random_triangles(seed);
    const Adjacency near = neighbours(kPoints, triangles);
    const Groups<std::uint32_t> fans = holders(kPoints, triangles);
    ASSERT_EQ(near.size(), kPoints);
    ASSERT_EQ(fans.size(), kPoints);
    for (std::uint32_t v = 0; v < kPoints; ++v) {
      std::set<std::uint32_t> expected;
      std::vector<std::uint32_t> fan;
      for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (std::find(triangles[t].begin(), triangles[t].end(), v) == triangles[t].end()) continue;
        fan.push_back(t);
        expected.insert(triangles[t].begin(), triangles[t].end());
      }
      expected.erase(v);
      EXPECT_EQ(std::vector(near[v].begin(), near[v].end()), std::vector(expected.begin(), expected.end()));
      EXPECT_EQ(std::vector(fans[v].begin(), fans[v].end()), fan);
    }
  }
}

}  // namespace
}  // namespace affskel::core
