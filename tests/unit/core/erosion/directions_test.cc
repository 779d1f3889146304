#include "core/erosion/directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

const Solid& box() {
  static const Solid solid = make_solid(make_box(3, 2, 1));
  return solid;
}

TEST(MakeDirections, TrianglesGiveTheirInwardNormals) {
  const DirectionSet set = make_directions(box(), "triangles");
  ASSERT_EQ(set.size(), 12U);
  const Mesh& mesh = box().mesh;
  for (std::size_t t = 0; t < set.size(); ++t) {
    EXPECT_NEAR(norm(set[t]), 1, 1e-15);
    // The box is centred at 0: inward is against the way to the triangle.
    EXPECT_LT(dot(set[t], mesh.points[mesh.triangles[t][0]]), 0);
  }
}

TEST(MakeDirections, SphereHasAtLeastAsManyAsAskedAndIsBalanced) {
  for (std::size_t n : {1U, 20U, 21U, 200U, 1000U}) {
    const DirectionSet set = make_directions(box(), "sphere:" + std::to_string(n));
    EXPECT_GE(set.size(), n);
    EXPECT_EQ(set.size() % 20, 0U);
    Vec3 sum;
    for (const Vec3& d : set) {
      EXPECT_NEAR(norm(d), 1, 1e-15);
      sum = sum + d;
    }
    EXPECT_LT(norm(sum), 1e-12);
  }
}

// No direction is farther from the set than the triangles of the sphere are wide.
TEST(MakeDirections, SphereCoversAllDirections) {
  const DirectionSet set = make_directions(box(), "sphere:2000");
  for (const Vec3& d : make_directions(box(), "random:500:7")) {
    double best = -1;
    for (const Vec3& s : set) best = std::max(best, dot(d, s));
    EXPECT_GT(best, std::cos(0.08));
  }
}

TEST(MakeDirections, RandomIsUniformAndAFunctionOfItsSeed) {
  const DirectionSet set = make_directions(box(), "random:20000:42");
  ASSERT_EQ(set.size(), 20000U);
  EXPECT_EQ(set, make_directions(box(), "random:20000:42"));
  EXPECT_NE(set, make_directions(box(), "random:20000:43"));
  Vec3 mean, square;
  for (const Vec3& d : set) {
    mean = mean + (1.0 / 20000) * d;
    square = square + (1.0 / 20000) * Vec3{d.x * d.x, d.y * d.y, d.z * d.z};
  }
  EXPECT_LT(norm(mean), 0.02);
  EXPECT_NEAR(square.x, 1.0 / 3, 0.01);
  EXPECT_NEAR(square.y, 1.0 / 3, 0.01);
  EXPECT_NEAR(square.z, 1.0 / 3, 0.01);
}

TEST(MakeDirections, UnionsKeepTheOrderOfTheirParts) {
  const DirectionSet set = make_directions(box(), "triangles+random:5:1");
  ASSERT_EQ(set.size(), 17U);
  EXPECT_EQ(set[0], make_directions(box(), "triangles")[0]);
  EXPECT_EQ(set[16], make_directions(box(), "random:5:1")[4]);
}

TEST(MakeDirections, RefusesWhatDoesNotParse) {
  for (const char* spec :
       {"", "triangle", "sphere", "sphere:", "sphere:0", "sphere:-5", "random:5", "random:5:x", "triangles+",
        "+triangles", "sphere:1e3", "sphere:99999999999999999999"}) {
    EXPECT_THROW(make_directions(box(), spec), CoreError) << spec;
  }
  try {
    make_directions(box(), "random:1000000000000:1");
    FAIL();
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kLimit);
  }
}

TEST(CheckDirections, RefusesWhatMakeDirectionsRefusesAndNothingElse) {
  DirectionOptions options;
  options.max_directions = 32;
  const auto refusal = [&](const auto& call, const char* spec) -> std::string {
    try {
      call(box(), spec, options);
      return "";
    } catch (const CoreError& error) {
      EXPECT_EQ(error.code(), CoreError::Code::kLimit);
      return error.what();
    }
  };
  for (const char* spec :
       {"triangles", "sphere:20", "sphere:21", "triangles+sphere:20", "triangles+random:20:1+sphere:1",
        "random:32:1", "random:33:1", "sphere:18446744073709551615+random:18446744073709551615:1"}) {
    EXPECT_EQ(refusal(check_directions, spec), refusal(make_directions, spec)) << spec;
  }
  EXPECT_EQ(refusal(check_directions, "triangles+sphere:20"), "");
  EXPECT_EQ(refusal(check_directions, "triangles+sphere:20+random:1:7"),
            "directions 'triangles+sphere:20+random:1:7': 33 directions; at most 32 are supported");
}

}  // namespace
}  // namespace affskel::core
