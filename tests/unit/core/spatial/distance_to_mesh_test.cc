#include "core/spatial/distance_to_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/split_mix64.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

class RandomPlaces {
 public:
  explicit RandomPlaces(std::uint64_t seed) : random_(seed) {}
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_.next() >> 11) * 0x1p-53);
  }
  Vec3 next(double reach) { return {within(-reach, reach), within(-reach, reach), within(-reach, reach)}; }

 private:
  SplitMix64 random_;
};

// By ever finer steps over the triangle.
TEST(DistanceToMesh, OfATriangleIsThatOfItsNearestPoint) {
  RandomPlaces random(5);
  for (int n = 0; n < 300; ++n) {
    const Vec3 a = random.next(1), b = random.next(1), c = n % 10 == 0 ? 0.5 * (a + b) : random.next(1);
    const Vec3 place = random.next(2);
    constexpr int kSteps = 200;
    double least = HUGE_VAL;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Vec3 at =
            a + (static_cast<double>(i) / kSteps) * (b - a) + (static_cast<double>(j) / kSteps) * (c - a);
        least = std::min(least, norm(at - place));
      }
    }
    const double found = norm(nearest_place(place, a, b, c) - place);
    EXPECT_LE(found, least + 1e-12);
    EXPECT_NEAR(found, least, 0.01);
  }
}

TEST(DistanceToMesh, OfABoxIsThatOfItsNearestSide) {
  const Mesh box = make_box(2, 3, 4);
  const DistanceToMesh distance(box);
  RandomPlaces random(6);
  for (int n = 0; n < 300; ++n) {
    const Vec3 at{random.within(0, 2), random.within(0, 3), random.within(0, 4)};
    EXPECT_NEAR(distance.nearest(at), std::min({at.x, 2 - at.x, at.y, 3 - at.y, at.z, 4 - at.z}), 1e-12);
    EXPECT_NEAR(distance.nearest({at.x, at.y, -at.z}), at.z, 1e-12);
    EXPECT_NEAR(distance.nearest({-at.x, -at.y, -at.z}), norm(at), 1e-12);
  }
}

TEST(DistanceToMesh, IsTheLeastOfAllTriangles) {
  const Mesh torus = make_torus(3, 1, 2048);
  const DistanceToMesh distance(torus);
  RandomPlaces random(7);
  for (int n = 0; n < 200; ++n) {
    const Vec3 place = random.next(5);
    double least = HUGE_VAL;
    for (const auto& [a, b, c] : torus.triangles)
      least = std::min(least,
                       norm(nearest_place(place, torus.points[a], torus.points[b], torus.points[c]) - place));
    EXPECT_EQ(distance.nearest(place), least);
  }
}

}  // namespace
}  // namespace affskel::core
