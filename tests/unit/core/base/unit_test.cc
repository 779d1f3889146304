#include "core/base/unit.h"

#include <gtest/gtest.h>

namespace affskel::core {
namespace {

TEST(Unit, IsTheSameAtEverySize) {
  const Vec3 v{3, -4, 12};
  for (const int exponent : {0, 1, -40, 900, -900}) {
    const Vec3 scaled{std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
    EXPECT_EQ(unit(scaled), unit(v)) << exponent;
    EXPECT_EQ(length_of(scaled), std::ldexp(13, exponent));
    EXPECT_EQ(largest_exponent(scaled), 3 + exponent);
  }
  EXPECT_EQ(unit(v), (1 / norm(v)) * v);
}

TEST(Unit, OfTheZeroVectorIsZero) {
  EXPECT_EQ(unit({}), Vec3{});
  EXPECT_EQ(length_of({}), 0);
}

}  // namespace
}  // namespace affskel::core
