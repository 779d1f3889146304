#include "core/curve/curve_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace affskel::core {
namespace {

// Lines from a place outwards, in steps of 1.
class Lines {
 public:
  std::uint32_t begin(const Vec3& at) { return add(at); }

  // @returns the last vertex.
  std::uint32_t go(std::uint32_t from, const Vec3& step, int steps) {
    for (int n = 0; n < steps; ++n) {
      const std::uint32_t to = add(places[from] + step);
      segments.push_back({from, to});
      from = to;
    }
    return from;
  }

  CurveGraph graph() const {
    return curve_graph(places, segments, std::vector<double>(places.size(), radius),
                       share.empty() ? even() : share);
  }

  // Of joints nothing.
  std::vector<double> even() const {
    std::vector<int> lines(places.size(), 0);
    for (const Segment& segment : segments)
      for (const std::uint32_t v : segment) ++lines[v];
    std::vector<double> result;
    for (const int count : lines) result.push_back(count > 2 ? 0 : 1);
    const double sum = std::accumulate(result.begin(), result.end(), 0.0);
    for (double& one : result) one /= sum;
    return result;
  }

  std::vector<Vec3> places;
  std::vector<Segment> segments;
  std::vector<double> share;
  double radius = 0.1;

 private:
  std::uint32_t add(const Vec3& at) {
    places.push_back(at);
    return static_cast<std::uint32_t>(places.size() - 1);
  }
};

// A trunk up the z axis; from its top two arms of 8 along +-x, from its foot one leg of 3.
Lines body() {
  Lines lines;
  const std::uint32_t foot = lines.begin({0, 0, 0});
  const std::uint32_t top = lines.go(foot, {0, 0, 1}, 20);
  lines.go(top, {1, 0, 0}, 8);
  lines.go(top, {-1, 0, 0}, 8);
  lines.go(top, {0, 0, 1}, 2);
  lines.go(foot, {0, 0.6, -0.8}, 3);
  lines.go(foot, {0, -0.6, -0.8}, 4);
  return lines;
}

TEST(CurveGraph, HasTheHeaviestBranchFirst) {
  const CurveGraph graph = body().graph();
  ASSERT_EQ(graph.branches.size(), 6U);
  EXPECT_EQ(graph.nodes.size(), 7U);
  EXPECT_EQ(graph.branches[0].kind, BranchKind::kLink);
  EXPECT_EQ(graph.branches[0].length, 20);
  for (const CurveBranch& branch : graph.branches) EXPECT_NEAR(branch.straight_length, branch.length, 1e-12);
  double sum = 0;
  for (const CurveBranch& branch : graph.branches) sum += branch.share;
  EXPECT_NEAR(sum, 1, 1e-12);
  for (std::size_t b = 1; b < 6; ++b) {
    EXPECT_EQ(graph.branches[b].kind, BranchKind::kLimb);
    EXPECT_EQ(graph.degree[graph.branches[b].to], 1U) << "a limb ends at its tip";
    EXPECT_LE(graph.branches[b].share, graph.branches[b - 1].share * (1 + 1e-12));
  }
}

// The two arms weigh nearly the same: noise in the shares does not make them change places, and neither does the order
// in which they are found.
TEST(CurveGraph, BranchesAboutEqualAreInTheOrderOfTheirPlaces) {
  for (int trial = 0; trial < 8; ++trial) {
    Lines lines = body();
    lines.share = lines.even();
    for (std::size_t v = 0; v < lines.places.size(); ++v)
      if (lines.places[v].x != 0) lines.share[v] *= (lines.places[v].x < 0) == (trial % 2 == 0) ? 1.01 : 0.99;
    if (trial >= 4) std::reverse(lines.segments.begin(), lines.segments.end());
    const CurveGraph graph = lines.graph();
    EXPECT_EQ(lines.places[graph.branches[1].vertices.back()], (Vec3{-8, 0, 20}));
    EXPECT_EQ(lines.places[graph.branches[2].vertices.back()], (Vec3{8, 0, 20}));
  }
}

// What of a limb has no share, from its joint on, belongs to the branch that has the joint.
TEST(CurveGraph, ALimbBeginsWhereItHasAShare) {
  Lines lines = body();
  lines.share = lines.even();
  for (std::size_t v = 0; v < lines.places.size(); ++v) {
    const Vec3& at = lines.places[v];
    if (std::abs(at.x) > 0 && std::abs(at.x) < 3) lines.share[v] = 0;
  }
  const CurveGraph graph = lines.graph();
  for (std::size_t v = 0; v < lines.places.size(); ++v) {
    const Vec3& at = lines.places[v];
    if (at.z == 20) {
      EXPECT_EQ(graph.part[v] == 0, std::abs(at.x) < 3) << at.x;
    }
  }
  for (const CurveBranch& branch : graph.branches) {
    double sum = 0;
    for (std::size_t v = 0; v < lines.places.size(); ++v)
      if (&graph.branches[graph.part[v]] == &branch) sum += lines.share[v];
    EXPECT_NEAR(branch.share, sum, 1e-12);
  }
}

// A joint with a share is a body, thicker than its limbs.
TEST(CurveGraph, ABodyThatLimbsHangOnIsAPoint) {
  Lines lines;
  const std::uint32_t middle = lines.begin({0, 0, 0});
  for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}}) lines.go(middle, way, 4);
  lines.share = {0.4, 0, 0.2, 0, 0, 0, 0, 0.3, 0, 0, 0.1, 0, 0};
  for (const bool turned : {false, true}) {
    if (turned) std::reverse(lines.segments.begin(), lines.segments.end());
    const CurveGraph graph = lines.graph();
    ASSERT_EQ(graph.branches.size(), 4U);
    EXPECT_EQ(graph.branches[0].kind, BranchKind::kPoint);
    EXPECT_EQ(graph.branches[0].share, 0.4);
    EXPECT_TRUE(std::isnan(graph.branches[0].angle));
    EXPECT_EQ(graph.nodes[graph.branches[0].from], middle);
    EXPECT_EQ(graph.branches[1].share, 0.3);
    EXPECT_NEAR(graph.branches[1].angle, 180, 1e-9) << "to the next limb, not to the point";
    EXPECT_EQ(graph.branches[1].angle_to, 2U);
    EXPECT_EQ(graph.branches[2].angle_to, 1U);
    EXPECT_EQ(graph.branches[0].angle_to, kNone);
    EXPECT_EQ(graph.degree[graph.branches[0].from], 3U);
    EXPECT_EQ(graph.part[1], 0U) << "where a limb has no share yet";
  }
}

// Limbs leave a body of radius 3 along +-x, and turn to y after another 2: outside of the body that is half of them.
TEST(CurveGraph, AnAngleAtABodyIsMeasuredFromWhereTheLimbLeavesIt) {
  Lines lines;
  lines.radius = 3;
  const std::uint32_t middle = lines.begin({0, 0, 0});
  const double half = std::sqrt(0.5);
  for (const double side : {-1., 1.})
    lines.go(lines.go(lines.go(middle, {side, 0, 0}, 3), {side * half, half, 0}, 4), {side * half, -half, 0},
             4);
  lines.go(middle, {0, 0, 1}, 4);
  for (const Vec3& place : lines.places)
    lines.share.push_back(norm(place) == 0 ? 0.8 : std::abs(place.x) < 3 ? 0 : 0.02);
  const CurveGraph graph = lines.graph();
  ASSERT_EQ(graph.branches.size(), 4U);
  for (const std::size_t limb : {1, 2}) EXPECT_NEAR(graph.branches[limb].angle, 90, 1e-9);
}

// A shaft that ends in a bow, and a tooth square to it: the bow tells nothing of how the shaft begins.
TEST(CurveGraph, AnAngleIsThatBeforeABranchBends) {
  Lines lines;
  lines.radius = 0.5;
  const std::uint32_t joint = lines.begin({0, 0, 0});
  lines.go(joint, {-1, 0, 0}, 10);
  lines.go(joint, {0, -1, 0}, 4);
  lines.go(lines.go(joint, {1, 0, 0}, 2), {0, -1, 0}, 3);
  for (const Vec3& place : lines.places) lines.share.push_back(place.x > 0 ? 0.02 : place.x < 0 ? 0.001 : 0);
  const CurveGraph graph = lines.graph();
  ASSERT_EQ(graph.branches.size(), 3U);
  for (const CurveBranch& branch : graph.branches)
    EXPECT_NEAR(branch.angle, norm(lines.places[branch.vertices.back()] - Vec3{0, -4, 0}) < 1e-9 ? 90 : 180,
                1e-6);
}

// From the top of a trunk a link to a fork: without a share it is no part.
TEST(CurveGraph, ALinkWithoutAShareComesLast) {
  Lines lines;
  const std::uint32_t top = lines.go(lines.begin({0, 0, 0}), {0, 0, 1}, 20);
  lines.go(top, {1, 0, 0}, 9);
  const std::uint32_t fork = lines.go(top, {0, 1, 0}, 3);
  for (const double x : {-1., 1.}) lines.go(fork, {x, 0, 0}, 6);
  lines.share = lines.even();
  for (std::size_t v = 0; v < lines.places.size(); ++v)
    if (lines.places[v].y == 1 || lines.places[v].y == 2) lines.share[v] = 0;
  const CurveGraph graph = lines.graph();
  ASSERT_EQ(graph.branches.size(), 5U);
  EXPECT_EQ(graph.branches[4].kind, BranchKind::kLink);
  EXPECT_EQ(graph.branches[4].share, 0);
  EXPECT_EQ(std::count(graph.part.begin(), graph.part.end(), 4U), 0);
}

TEST(CurveGraph, AnglesAreToTheFirstOtherBranch) {
  const CurveGraph graph = body().graph();
  EXPECT_NEAR(graph.branches[1].angle, 90, 1e-9);
  EXPECT_NEAR(graph.branches[2].angle, 90, 1e-9);
  for (const std::size_t leg : {3U, 4U})
    EXPECT_NEAR(graph.branches[leg].angle, 180 - 36.86989764584402, 1e-9);  // a slope of 3 in 4
  EXPECT_NEAR(graph.branches[5].angle, 180, 1e-9) << "the neck goes straight on";
}

// By a little, so that their numbers are those of their places.
TEST(CurveGraph, AnglesAreToTheHeaviestBranchWhereverItIs) {
  for (const double side : {-1.0, 1.0}) {
    Lines lines;
    const std::uint32_t joint = lines.begin({0, 0, 0});
    lines.go(joint, {side, 0, 0}, 100);
    lines.go(joint, {-side, 0, 0}, 60);
    lines.go(joint, {0, 0, side}, 103);
    const CurveGraph graph = lines.graph();
    ASSERT_EQ(graph.branches.size(), 3U);
    EXPECT_NEAR(graph.branches[2].angle, 90, 1e-9) << side;
  }
}

// Near a joint lines bend into each other; the angle is that of what follows.
TEST(CurveGraph, AnglesAreThoseBeyondTheJoint) {
  Lines lines;
  const std::uint32_t foot = lines.begin({0, 0, 0});
  const std::uint32_t joint = lines.go(foot, {0, 0, 1}, 20);
  lines.go(joint, {0, 0, 1}, 10);
  const std::uint32_t bent = lines.go(joint, {0, 0, 1}, 1);  // beside the trunk, then out
  lines.go(lines.go(bent, {0.6, 0, 0.8}, 1), {1, 0, 0}, 6);
  lines.radius = 2;
  const CurveGraph graph = lines.graph();
  const auto arm = std::find_if(graph.branches.begin(), graph.branches.end(),
                                [](const CurveBranch& branch) { return branch.length == 8; });
  ASSERT_NE(arm, graph.branches.end());
  EXPECT_NEAR(arm->angle, 90, 1e-6);
}

TEST(CurveGraph, AJointIsOfNoLimbsThickness) {
  Lines lines = body();
  std::vector<double> radius(lines.places.size(), 0.1);
  std::vector<int> ends(lines.places.size(), 0);
  for (const Segment& segment : lines.segments)
    for (const std::uint32_t v : segment) ++ends[v];
  for (std::size_t v = 0; v < radius.size(); ++v)
    if (ends[v] > 2) radius[v] = 5;
  for (const CurveBranch& branch : curve_graph(lines.places, lines.segments, radius, lines.even()).branches)
    EXPECT_EQ(branch.greatest_radius, 0.1);
}

TEST(CurveGraph, OfALoopAndOfAPlace) {
  Lines lines;
  lines.places = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}};
  lines.segments = {{0, 1}, {1, 2}, {2, 0}};
  lines.share = {0.2, 0.2, 0.2, 0.4};
  const CurveGraph graph = lines.graph();
  ASSERT_EQ(graph.branches.size(), 2U);
  EXPECT_EQ(graph.branches[0].kind, BranchKind::kLoop);
  EXPECT_EQ(graph.branches[0].from, graph.branches[0].to);
  EXPECT_NEAR(graph.branches[0].share, 0.6, 1e-12);
  EXPECT_EQ(graph.branches[0].straight_length, 0);
  EXPECT_EQ(graph.branches[1].kind, BranchKind::kPoint);
  EXPECT_EQ(graph.branches[1].vertices, (std::vector<std::uint32_t>{3}));
  EXPECT_EQ(graph.branches[1].length, 0);
  EXPECT_EQ(graph.branches[1].mean_radius, 0.1);
  for (const CurveBranch& branch : graph.branches) EXPECT_TRUE(std::isnan(branch.angle));
  EXPECT_EQ(graph.part, (std::vector<std::uint32_t>{0, 0, 0, 1}));
  EXPECT_EQ(graph.degree, (std::vector<std::uint32_t>{2, 0}));
}

TEST(CurveGraph, ALineHasTwoFreeEndsAndALinkBeginsAtTheHeavierJoint) {
  Lines line;
  line.go(line.begin({0, 0, 0}), {1, 0, 0}, 3);
  EXPECT_EQ(line.graph().branches.at(0).kind, BranchKind::kLine);
  // A trunk of 20, a link of 5 from its top to a fork of three.
  for (const bool turned : {false, true}) {
    Lines lines;
    const std::uint32_t foot = lines.begin({0, 0, 0});
    const std::uint32_t top = lines.go(foot, {0, 0, 1}, 20);
    lines.go(top, {1, 0, 0}, 9);
    const std::uint32_t fork = lines.go(top, {0, 1, 0}, 5);
    for (const double x : {-1., 1.}) lines.go(fork, {x, 0, 0}, 2);
    if (turned) std::reverse(lines.segments.begin(), lines.segments.end());
    const CurveGraph graph = lines.graph();
    const auto link =
        std::find_if(graph.branches.begin(), graph.branches.end(),
                     [](const CurveBranch& branch) { return branch.kind == BranchKind::kLink; });
    ASSERT_NE(link, graph.branches.end());
    EXPECT_EQ(graph.nodes[link->from], top);
    EXPECT_EQ(link->vertices.front(), top);
    EXPECT_EQ(link->vertices.back(), fork);
    EXPECT_NEAR(link->angle, 90, 1e-9);
  }
}

}  // namespace
}  // namespace affskel::core
