#include "client/cli/affine_steps.h"

#include <gtest/gtest.h>

#include "client/base/error.h"

namespace affskel::client {
namespace {

using core::Vec3;

Vec3 moved(const AffineStep& step, const Vec3& point = {1, 2, 4}) {
  return affine_step(step)(point);
}

TEST(AffineSteps, EveryFormDoesWhatItSays) {
  EXPECT_EQ(moved({"--matrix", "1,2,3, 0,1,0, 0,0,2"}), (Vec3{17, 2, 8}));
  EXPECT_EQ(moved({"--matrix", "1,0,0,10, 0,1,0,20, 0,0,1,-30"}), (Vec3{11, 22, -26}));
  EXPECT_EQ(moved({"--scale", "2"}), (Vec3{2, 4, 8}));
  EXPECT_EQ(moved({"--scale", "2,1,0.5"}), (Vec3{2, 2, 2}));
  EXPECT_EQ(moved({"--translate", "-1,0,1"}), (Vec3{0, 2, 5}));
  EXPECT_EQ(moved({"--rotate", "z:90"}), (Vec3{-2, 1, 4}));
  EXPECT_EQ(moved({"--rotate", "x:-90"}), (Vec3{1, 4, -2}));
  EXPECT_EQ(moved({"--shear", "y+=z"}), (Vec3{1, 6, 4}));
  EXPECT_EQ(moved({"--shear", "y += 0.5 z"}), (Vec3{1, 4, 4}));
  EXPECT_EQ(moved({"--shear", "x+=-2*y"}), (Vec3{-3, 2, 4}));
  EXPECT_EQ(moved({"--shear", "zx:3"}), (Vec3{1, 2, 7}));
}

TEST(AffineSteps, OrderMatters) {
  const AffineStep scale{"--scale", "2"}, shift{"--translate", "1,0,0"};
  EXPECT_EQ(affine_map_of({scale, shift})({1, 0, 0}), (Vec3{3, 0, 0}));
  EXPECT_EQ(affine_map_of({shift, scale})({1, 0, 0}), (Vec3{4, 0, 0}));
}

TEST(AffineSteps, WhatIsNoStepIsWrongUsage) {
  const std::vector<AffineStep> wrong = {{"--matrix", "1,2,3"},  {"--matrix", "1,2,3,4,5,6,7,8,x"},
                                         {"--scale", ""},        {"--scale", "1,2"},
                                         {"--scale", "nan"},     {"--translate", "1"},
                                         {"--rotate", "30"},     {"--rotate", "w:30"},
                                         {"--rotate", "z:"},     {"--rotate", "z:30deg"},
                                         {"--shear", "y+=y"},    {"--shear", "yy:1"},
                                         {"--shear", "yz"},      {"--shear", "yz:"},
                                         {"--shear", "y-=z"},    {"--shear", "y+="},
                                         {"--shear", "a+=z"},    {"--shear", "y+=*z"},
                                         {"--rotate", "z:1e999"}};
  for (const AffineStep& step : wrong) {
    try {
      affine_step(step);
      ADD_FAILURE() << step.option << " " << step.value;
    } catch (const ClientError& error) {
      EXPECT_EQ(error.exit_code(), ExitCode::kUsage);
      EXPECT_NE(std::string(error.what()).find(step.option), std::string::npos);
    }
  }
}

TEST(AffineSteps, ASingularWholeIsWrongUsage) {
  for (const AffineStep& step :
       {AffineStep{"--scale", "1,0,1"}, AffineStep{"--matrix", "1,2,3,4,5,6,7,8,9"}}) {
    EXPECT_THROW(affine_map_of({step}), ClientError);
  }
}

}  // namespace
}  // namespace affskel::client
