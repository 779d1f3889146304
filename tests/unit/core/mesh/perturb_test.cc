#include "core/mesh/perturb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/mesh/coincident_points.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"

namespace affskel::core {
namespace {

TEST(PerturbTest, TheNoiseIsGaussian) {
  // Moments and tail shares of 60 000 numbers, within four standard errors of those of N(0, 1).
  Mesh cloud;
  for (int i = 0; i < 20000; ++i) cloud.points.push_back({double(i), 0, 0});
  const Mesh noisy = perturb(cloud, {3, 7});
  double mean = 0, square = 0, fourth = 0, beyond_one = 0, beyond_two = 0;
  const double count = 3.0 * static_cast<double>(cloud.points.size());
  for (std::size_t v = 0; v < cloud.points.size(); ++v) {
    const Vec3 shift = noisy.points[v] - cloud.points[v];
    for (int c = 0; c < 3; ++c) {
      const double x = shift[c] / 3;
      mean += x / count;
      square += x * x / count;
      fourth += x * x * x * x / count;
      beyond_one += std::abs(x) > 1 ? 1 / count : 0;
      beyond_two += std::abs(x) > 2 ? 1 / count : 0;
    }
  }
  EXPECT_NEAR(mean, 0, 4 / std::sqrt(count));
  EXPECT_NEAR(square, 1, 4 * std::sqrt(2 / count));
  EXPECT_NEAR(fourth, 3, 4 * std::sqrt(96 / count));
  EXPECT_NEAR(beyond_one, 0.317311, 4 * std::sqrt(0.317 * 0.683 / count));
  EXPECT_NEAR(beyond_two, 0.045500, 4 * std::sqrt(0.0455 * 0.9545 / count));
}

TEST(PerturbTest, TheSeedDecidesTheNoise) {
  const Mesh box = make_box(3, 2, 1);
  EXPECT_EQ(perturb(box, {0.1, 5}).points, perturb(box, {0.1, 5}).points);
  EXPECT_NE(perturb(box, {0.1, 5}).points, perturb(box, {0.1, 6}).points);
  EXPECT_EQ(perturb(box, {0, 5}).points, box.points);
  EXPECT_EQ(perturb(box, {0.1, 5}).triangles, box.triangles);
}

TEST(PerturbTest, VerticesAtOnePlaceMoveTogether) {
  // A soup: every triangle has corners of its own, one of them at -0 instead of 0.
  const Mesh box = make_box(3, 2, 1);
  Mesh soup;
  for (const Triangle& t : box.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t corner : t) soup.points.push_back(box.points[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.points.back() = {soup.points.back().x == 0 ? -0.0 : soup.points.back().x, soup.points.back().y,
                        soup.points.back().z};
  const Mesh noisy = perturb(soup, {0.01, 1});
  const std::vector<std::uint32_t> before = first_coincident_point(soup.points);
  EXPECT_EQ(first_coincident_point(noisy.points), before);
  EXPECT_EQ(make_solid(noisy).mesh.points.size(), 8u);  // welds, and is closed
}

TEST(PerturbTest, RefusesWhatIsNoNoise) {
  const Mesh box = make_box(1, 1, 1);
  EXPECT_THROW(perturb(box, {-1, 1}), CoreError);
  EXPECT_THROW(perturb(box, {std::numeric_limits<double>::quiet_NaN(), 1}), CoreError);
  EXPECT_THROW(perturb(box, {std::numeric_limits<double>::max(), 1}), CoreError);
}

}  // namespace
}  // namespace affskel::core
