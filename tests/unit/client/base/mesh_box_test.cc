#include "client/base/mesh_box.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

TEST(MeshBox, IsTheLeastBoxOfThePoints) {
  const Box box = mesh_box({{{1, -2, 3}, {-4, 5, 3}, {0, 0, 9}}, {}});
  EXPECT_EQ(box.low, (core::Vec3{-4, -2, 3}));
  EXPECT_EQ(box.high, (core::Vec3{1, 5, 9}));
  EXPECT_EQ(box.size(), (core::Vec3{5, 7, 6}));
  EXPECT_EQ(box.centre(), (core::Vec3{-1.5, 1.5, 6}));
}

}  // namespace
}  // namespace affskel::client
