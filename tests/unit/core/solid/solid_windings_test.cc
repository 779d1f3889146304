#include "core/solid/solid_windings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Of a closed way through places, with what is farthest from an integer.
struct Round {
  std::vector<long> number;
  double error = 0;
};

Round round_of(const SolidWindings& windings, const std::vector<Vec3>& places) {
  std::vector<double> sum(windings.size(), 0);
  for (std::size_t n = 0; n < places.size(); ++n) {
    const std::vector<double> part = windings.along(places[n], places[(n + 1) % places.size()]);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
  }
  Round result;
  for (const double one : sum) {
    result.number.push_back(std::lround(one));
    result.error = std::max(result.error, std::abs(one - std::round(one)));
  }
  return result;
}

std::vector<Vec3> circle(const Vec3& centre, const Vec3& a, const Vec3& b, int steps) {
  std::vector<Vec3> places;
  for (int n = 0; n < steps; ++n) {
    const double angle = 2 * std::numbers::pi * n / 17;
    places.push_back(centre + (std::cos(angle) * a + std::sin(angle) * b));
  }
  return places;
}

long greatest(const Round& round) {
  long result = 0;
  for (const long one : round.number) result = std::max(result, std::abs(one));
  return result;
}

TEST(SolidWindings, CountHowOftenAWayGoesThroughATunnel) {
  const SolidWindings torus(make_torus(3, 1, 512));
  ASSERT_EQ(torus.size(), 2U);
  const Round once = round_of(torus, circle({}, {3, 0, 0}, {0, 3, 0}, 17));
  const Round twice = round_of(torus, circle({}, {3, 0, 0}, {0, 3, 0}, 34));
  EXPECT_EQ(greatest(once), 1);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(twice.number[k], 2 * once.number[k]);
  EXPECT_LT(std::max(once.error, twice.error), 1e-9);
}

// In the tube, and in a solid without a tunnel.
TEST(SolidWindings, AreNoneOfWhatBounds) {
  const SolidWindings torus(make_torus(3, 1, 512));
  EXPECT_EQ(greatest(round_of(torus, circle({3, 0, 0}, {0.8, 0, 0}, {0, 0, 0.8}, 17))), 0);
  EXPECT_EQ(greatest(round_of(torus, circle({0, -3, 0}, {0.5, 0, 0}, {0, 0.3, 0.4}, 17))), 0);
  EXPECT_EQ(SolidWindings(hollow_ball()).size(), 0U);
}

// Two linked rings, as one solid of two pieces: each way in one of them is told from the other's.
TEST(SolidWindings, TellTunnelsApart) {
  Mesh other = make_torus(3, 1, 512);
  for (Vec3& p : other.points) p = {p.x + 3, p.z, -p.y};
  const SolidWindings both(joined(make_torus(3, 1, 512), other));
  ASSERT_EQ(both.size(), 4U);
  const Round a = round_of(both, circle({}, {3, 0, 0}, {0, 3, 0}, 17));
  const Round b = round_of(both, circle({3, 0, 0}, {3, 0, 0}, {0, 0, 3}, 17));
  EXPECT_LT(std::max(a.error, b.error), 1e-9);
  bool independent = false;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t l = 0; l < 4; ++l) independent |= a.number[k] * b.number[l] != a.number[l] * b.number[k];
  EXPECT_TRUE(independent);
}

}  // namespace
}  // namespace affskel::core
