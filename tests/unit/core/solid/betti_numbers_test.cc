#include "core/solid/betti_numbers.h"

#include <gtest/gtest.h>

#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

BettiNumbers of(const Mesh& mesh) {
  return betti_numbers(make_solid(mesh));
}

TEST(SolidBettiNumbers, OfBallTorusAndHollowBall) {
  EXPECT_EQ(of(make_sphere(1, 80)), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(of(make_torus(3, 1, 128)), (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(of(hollow_ball()), (BettiNumbers{1, 0, 1}));
}

// A torus-shaped cavity leaves a loop through its own hole: b1 of the solid counts the inner genus too.
TEST(SolidBettiNumbers, CountTheGenusOfCavities) {
  const Mesh block = moved(make_box(10, 10, 10), {-5, -5, -5});
  EXPECT_EQ(of(joined(block, reversed(make_torus(3, 1, 128)))), (BettiNumbers{1, 1, 1}));
}

TEST(SolidBettiNumbers, AddUpOverSolids) {
  const Mesh torus = make_torus(3, 1, 128);
  const Mesh three = joined(joined(torus, moved(torus, {20, 0, 0})), moved(hollow_ball(), {40, 0, 0}));
  EXPECT_EQ(of(three), (BettiNumbers{3, 2, 1}));
}

}  // namespace
}  // namespace affskel::core
