// What is measured of tubes and trees of them, against closed forms: lengths within a spacing, angles within two degrees,
// volumes of parts within 1 %.
#include "core/curve/tubes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "core/curve/curved.h"
#include "core/mesh/perturb.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

using std::numbers::pi;

constexpr double kEdge = 0.2, kPoints = 25'000;

struct Measured {
  double h = 0, volume = 0;
  CurveGraph graph;
  std::vector<Vec3> places;  // per vertex

  // The branch whose far end is nearest to a place.
  const CurveBranch& to(const Vec3& place) const {
    const auto distance = [&](const CurveBranch& branch) {
      return norm(places[branch.vertices.back()] - place);
    };
    return *std::min_element(
        graph.branches.begin(), graph.branches.end(),
        [&](const CurveBranch& a, const CurveBranch& b) { return distance(a) < distance(b); });
  }
};

Measured measured(const Mesh& mesh, double points = kPoints) {
  Measured result;
  result.volume = make_solid(mesh).volume;
  result.h = std::cbrt(result.volume / points);
  const Curved solid(mesh, result.h, "sphere:320");
  const CurveSkeleton curve = solid.at();
  result.graph = solid.graph(curve);
  for (const SheetVertex& vertex : curve.vertices) result.places.push_back(solid.place(vertex));
  return result;
}

std::vector<Tube> all_turned(std::vector<Tube> tubes) {
  for (Tube& tube : tubes) tube = {turned(tube.from), turned(tube.to), tube.radius};
  return tubes;
}

TEST(Tubes, OneIsAsLongAsItsAxis) {
  const std::vector<Tube> tubes = all_turned({{{0, 0, 0}, {0, 0, 10}, 1}});
  const Measured tube = measured(tube_mesh(tubes, kEdge));
  ASSERT_EQ(tube.graph.branches.size(), 1U);
  const CurveBranch& axis = tube.graph.branches[0];
  EXPECT_EQ(axis.kind, BranchKind::kLine);
  EXPECT_NEAR(axis.length, 10, tube.h);
  EXPECT_NEAR(axis.straight_length, 10, tube.h);
  EXPECT_NEAR(axis.mean_radius, 1, 0.01);
  EXPECT_NEAR(axis.greatest_radius, 1, 0.02);
  for (const std::uint32_t v : axis.vertices) {
    const Vec3& at = tube.places[v];
    const Vec3 along = tubes[0].to - tubes[0].from;
    EXPECT_LT(norm(at - (dot(at, along) / dot(along, along)) * along), 0.1 * tube.h) << "beside the axis";
  }
}

TEST(Tubes, ATorusIsItsCoreCircle) {
  const Measured torus = measured(make_torus(3, 0.7, 5000));
  ASSERT_EQ(torus.graph.branches.size(), 1U);
  const CurveBranch& circle = torus.graph.branches[0];
  EXPECT_EQ(circle.kind, BranchKind::kLoop);
  EXPECT_NEAR(circle.length, 6 * pi, torus.h);
  EXPECT_NEAR(circle.least_radius, 0.7, 0.03);
  EXPECT_NEAR(circle.greatest_radius, 0.7, 0.03);
  for (const Vec3& at : torus.places) {
    EXPECT_NEAR(std::hypot(at.x, at.y), 3, 0.5 * torus.h);
    EXPECT_NEAR(at.z, 0, 0.1 * torus.h);
  }
}

// Two turns.
TEST(Tubes, AHelixIsAsLongAsItsAxis) {
  constexpr int kParts = 60;
  std::vector<Tube> tubes;
  double length = 0;
  const auto at = [](int n) {
    const double turn = 4 * pi * n / kParts;
    return Vec3{2 * std::cos(turn), 2 * std::sin(turn), 1.5 * turn / pi};
  };
  for (int n = 0; n < kParts; ++n) {
    tubes.push_back({at(n), at(n + 1), 0.4});
    length += norm(at(n + 1) - at(n));
  }
  const Measured helix = measured(tube_mesh(tubes, 0.15));
  ASSERT_EQ(helix.graph.branches.size(), 1U);
  EXPECT_NEAR(helix.graph.branches[0].length, length, 1.5 * helix.h);  // 320 times as long
  EXPECT_NEAR(helix.graph.branches[0].mean_radius, 0.4, 0.01);
}

// An arm from the middle of a trunk, at some angles.
TEST(Tubes, AnArmHasItsLengthAngleAndVolume) {
  for (const double angle : {90., 60.}) {
    const double turn = angle * pi / 180;
    const std::vector<Tube> tubes = all_turned(
        {{{0, 0, -10}, {0, 0, 10}, 1}, {{0, 0, 0}, {8 * std::sin(turn), 0, 8 * std::cos(turn)}, 0.5}});
    const Measured solid = measured(tube_mesh(tubes, 0.16));
    ASSERT_EQ(solid.graph.branches.size(), 3U) << angle;
    const CurveBranch& arm = solid.to(tubes[1].to);
    const auto outside_trunk = [&](const Vec3& p) { return !tubes[0].contains(p); };
    EXPECT_NEAR(arm.length, 8, solid.h) << angle;
    EXPECT_NEAR(arm.mean_radius, 0.5, 0.01) << angle;
    EXPECT_NEAR(std::min(arm.angle, 180 - arm.angle), angle, 2);
    EXPECT_NEAR(arm.share * solid.volume / volume_where(tubes[1], outside_trunk), 1, 0.01) << angle;
    for (const Vec3& end : {tubes[0].from, tubes[0].to}) EXPECT_NEAR(solid.to(end).length, 10, solid.h);
    // Its own all along: near the joint sections have a part of the other.
    for (const auto& [end, radius] : {std::pair{tubes[0].from, 1.}, {tubes[0].to, 1.}, {tubes[1].to, 0.5}}) {
      EXPECT_NEAR(solid.to(end).least_radius, radius, 0.02 * radius) << angle;
      EXPECT_NEAR(solid.to(end).greatest_radius, radius, 0.02 * radius) << angle;
    }
    double sum = 0;
    for (const CurveBranch& branch : solid.graph.branches) sum += branch.share;
    EXPECT_NEAR(sum, 1, 1e-9);
  }
}

// Arms of a ball begin at it: what is nearest to their lines there is a part of it.
TEST(Tubes, ArmsOfABallAreAsThickAsTheyAre) {
  std::vector<Tube> tubes{{{0, 0, 0}, {0, 0, 0.01}, 5.5}};
  for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}})
    tubes.push_back({{}, 13 * way, 1});
  const Measured solid = measured(tube_mesh(tubes, 0.3));
  ASSERT_EQ(solid.graph.branches.size(), 5U);
  for (const CurveBranch& branch : solid.graph.branches) {
    if (branch.kind == BranchKind::kPoint) continue;
    EXPECT_NEAR(branch.least_radius, 1, 0.03);
    EXPECT_NEAR(branch.greatest_radius, 1, 0.03);
  }
}

// Lines lead into the corners at its ends, or stop as far before as it is thick.
TEST(Tubes, ABarIsAsLongAsFromFaceToFace) {
  constexpr double kLength = 16;
  const auto bar = [](Mesh mesh) {
    for (Vec3& p : mesh.points) p = turned(p);
    return measured(mesh, 10'000);
  };
  const double flat = std::sqrt(8 / pi), triangle = std::sqrt(0.75 * std::sqrt(3.) / pi) * 1.5;
  for (const auto& [mesh, radius] : {std::pair{make_box(2, 2, kLength, 16), std::sqrt(4 / pi)},
                                     {make_box(4, 2, kLength, 16), flat},
                                     {make_cylinder(1.5, kLength, 3), triangle},
                                     {make_cylinder(1, kLength, 24), 1.}}) {
    const Measured solid = bar(mesh);
    ASSERT_EQ(solid.graph.branches.size(), 1U);
    const CurveBranch& axis = solid.graph.branches[0];
    EXPECT_NEAR(axis.length, kLength, solid.h) << radius;
    EXPECT_NEAR(axis.straight_length, kLength, solid.h) << radius;
    EXPECT_NEAR(axis.mean_radius, radius, 0.02 * radius);
    EXPECT_NEAR(axis.greatest_radius, radius, 0.03 * radius);
  }
}

// Two forks above a trunk.
TEST(Tubes, ATreeHasTheLengthsAndAnglesOfItsBranches) {
  const std::vector<Tube> tubes = all_turned({{{0, 0, -8}, {0, 0, 0}, 1},
                                              {{0, 0, 0}, {4, 0, 5}, 0.7},
                                              {{0, 0, 0}, {-4, 0, 5}, 0.7},
                                              {{4, 0, 5}, {5, 3, 9}, 0.5},
                                              {{4, 0, 5}, {8, -2, 8}, 0.5},
                                              {{-4, 0, 5}, {-5, -3, 9}, 0.5},
                                              {{-4, 0, 5}, {-8, 2, 8}, 0.5}});
  const Measured tree = measured(tube_mesh(tubes, kEdge));
  ASSERT_EQ(tree.graph.branches.size(), 7U);
  EXPECT_EQ(tree.graph.nodes.size(), 8U);
  const auto angle = [](const Vec3& a, const Vec3& b) {
    return 180 / pi * std::acos(dot(a, b) / (norm(a) * norm(b)));
  };
  EXPECT_NEAR(tree.to(tubes[0].from).length, 8, tree.h);
  for (std::size_t n = 1; n < tubes.size(); ++n) {
    const Tube& before = tubes[n < 3 ? 0 : (n - 1) / 2];
    const Vec3 back = before.from - before.to;
    const CurveBranch& branch = tree.to(tubes[n].to);
    EXPECT_NEAR(branch.length, norm(tubes[n].to - tubes[n].from), tree.h) << n;
    EXPECT_NEAR(branch.mean_radius, tubes[n].radius, 0.02) << n;
    EXPECT_NEAR(branch.angle, angle(tubes[n].to - tubes[n].from, back), 2) << n;
  }
}

// Of each but what it has within the one that it hangs on; of what two siblings have in common, half.
TEST(Tubes, ATreeHasTheVolumesOfItsBranches) {
  const std::vector<Tube> tubes = all_turned({{{0, 0, -8}, {0, 0, 0}, 1},
                                              {{0, 0, 0}, {6, 0, 3}, 0.7},
                                              {{0, 0, 0}, {-6, 0, 3}, 0.7},
                                              {{6, 0, 3}, {7, 4, 7}, 0.45},
                                              {{6, 0, 3}, {10, -3, 4}, 0.45}});
  const Measured tree = measured(tube_mesh(tubes, 0.16), 100'000);
  ASSERT_EQ(tree.graph.branches.size(), 5U);
  const std::vector<int> parent{-1, 0, 0, 1, 1}, sibling{-1, 2, 1, 4, 3};
  for (std::size_t n = 1; n < tubes.size(); ++n) {
    const double own = volume_where(tubes[n], [&](const Vec3& p) {
      const Tube& other = tubes[static_cast<std::size_t>(sibling[n])];
      return !tubes[static_cast<std::size_t>(parent[n])].contains(p) &&
             tubes[n].distance(p) < other.distance(p);
    });
    EXPECT_NEAR(tree.to(tubes[n].to).share * tree.volume / own, 1, 0.01) << n;
  }
  const double trunk = volume_where(tubes[0], [](const Vec3&) { return true; });
  EXPECT_NEAR(tree.to(tubes[0].from).share * tree.volume / trunk, 1, 0.01);
}

// A ring with three arms in its plane: three links round, which together are the ring.
TEST(Tubes, ARingHasTheVolumesOfItsArms) {
  constexpr double kMajor = 3, kMinor = 0.6;
  const auto ring = [](const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - kMajor, p.z) - kMinor; };
  std::vector<Tube> arms;
  for (const double degrees : {10., 130., 250.}) {
    const Vec3 out{std::cos(degrees * pi / 180), std::sin(degrees * pi / 180), 0};
    arms.push_back({kMajor * out, 8 * out, 0.35});
  }
  const ImplicitFunction f = [&](const Vec3& p) {
    double least = ring(p);
    for (const Tube& arm : arms) least = std::min(least, arm.distance(p));
    return least;
  };
  Mesh mesh = mesh_zero_set(f, {{-9, -9, -1}, {9, 9, 1}, 0.15});
  fair_onto(f, 1e-3, 3, mesh);
  const Measured solid = measured(mesh, 100'000);
  ASSERT_EQ(solid.graph.branches.size(), 6U);
  double links = 0;
  for (const CurveBranch& branch : solid.graph.branches)
    if (branch.kind == BranchKind::kLink) links += branch.share * solid.volume;
  EXPECT_NEAR(links / (2 * pi * pi * kMajor * kMinor * kMinor), 1, 0.01);
  for (const Tube& arm : arms) {
    const CurveBranch& branch = solid.to(arm.to);
    const double own = volume_where(arm, [&](const Vec3& p) { return ring(p) > 0; });
    EXPECT_NEAR(branch.share * solid.volume / own, 1, 0.01);
    EXPECT_NEAR(branch.length, norm(arm.to - arm.from), solid.h);
    EXPECT_NEAR(branch.mean_radius, arm.radius, 0.01);
  }
}

// Two arms, a neck and a trunk that meet in one place: a joint of four, whatever links the lattice leaves.
TEST(Tubes, FourThatMeetHaveOneJoint) {
  const std::vector<Tube> tubes = all_turned({{{0, 0, -8}, {0, 0, 0}, 1},
                                              {{0, 0, 0}, {5, 0, 0}, 0.5},
                                              {{0, 0, 0}, {-5, 0, 0}, 0.5},
                                              {{0, 0, 0}, {0, 0, 4}, 0.6}});
  const Measured solid = measured(tube_mesh(tubes, kEdge));
  ASSERT_EQ(solid.graph.branches.size(), 4U);
  ASSERT_EQ(solid.graph.nodes.size(), 5U);
  EXPECT_EQ(*std::max_element(solid.graph.degree.begin(), solid.graph.degree.end()), 4U);
  for (std::size_t n = 1; n < 3; ++n) EXPECT_NEAR(solid.to(tubes[n].to).angle, 90, 2);
  EXPECT_NEAR(solid.to(tubes[3].to).angle, 180, 2);
}

// An octopus: lines run below its head from arm to arm, in another way at each spacing.
TEST(Tubes, EqualArmsOfABallAreEqualAndItIsOnePart) {
  std::vector<Tube> arms;
  for (int n = 0; n < 8; ++n) {
    const Vec3 out{std::cos(n * pi / 4 + 0.1), std::sin(n * pi / 4 + 0.1), 0};
    arms.push_back({0.8 * out + Vec3{0, 0, -0.8}, 5 * out + Vec3{0, 0, -1.6}, 0.4});
  }
  const ImplicitFunction f = [&](const Vec3& p) {
    double least = norm(p - Vec3{0, 0, 0.8}) - 1.6;
    for (const Tube& arm : arms) least = std::min(least, arm.distance(p));
    return least;
  };
  Mesh mesh = mesh_zero_set(f, {{-5.6, -5.6, -2.2}, {5.6, 5.6, 2.6}, 0.15});
  fair_onto(f, 1e-3, 3, mesh);
  for (const double points : {25'000., 45'000.}) {
    const Measured solid = measured(mesh, points);
    std::vector<double> shares, lengths;
    for (const Tube& arm : arms) {
      shares.push_back(solid.to(arm.to).share);
      lengths.push_back(solid.to(arm.to).length);
    }
    const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
    const auto [shortest, longest] = std::minmax_element(lengths.begin(), lengths.end());
    EXPECT_LT(*longest - *shortest, 0.4)
        << points;                              // an arm's radius; within the body lines run as they please
    EXPECT_LT(*most / *least, 1.06) << points;  // 3 % either way
    const CurveBranch& body = solid.graph.branches[0];
    EXPECT_EQ(body.kind, BranchKind::kPoint) << points;
    EXPECT_NEAR(body.share + std::accumulate(shares.begin(), shares.end(), 0.0), 1, 0.001) << points;
  }
}

// Spurs and links run in a seat as noise would have it; it is one part, and its legs are equal.
TEST(Tubes, ASeatIsOnePartUnderNoise) {
  const auto box = [](const Vec3& low, const Vec3& high, const Vec3& p) {
    const auto out = [](double a, double b, double x) { return std::max(a - x, x - b); };
    return std::max({out(low.x, high.x, p.x), out(low.y, high.y, p.y), out(low.z, high.z, p.z)});
  };
  const ImplicitFunction f = [&](const Vec3& p) {
    const Vec3 leg{std::abs(p.x), std::abs(p.y), p.z};
    return std::min({box({-20, -20, 40}, {20, 20, 45}, p), box({14, 14, 0}, {19, 19, 42}, leg),
                     box({14, 14, 42}, {19, 19, 80}, {leg.x, p.y, p.z}),
                     box({-16, 14, 75}, {16, 19, 80}, p)});
  };
  const Mesh mesh = mesh_zero_set(f, {{-22.03, -22.03, -2.03}, {22, 22, 82}, 1.6});
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Measured solid = measured(perturb(mesh, {0.1, seed}));
    std::vector<double> legs;
    for (const double x : {-16.5, 16.5})
      for (const double y : {-16.5, 16.5}) {
        const CurveBranch& leg = solid.to({x, y, 0});
        EXPECT_EQ(leg.kind, BranchKind::kLimb) << seed;
        EXPECT_NEAR(leg.length, 40, 4) << seed;
        legs.push_back(leg.share);
      }
    const CurveBranch& seat = solid.graph.branches[0];
    EXPECT_EQ(seat.kind, BranchKind::kPoint) << seed;
    EXPECT_NEAR(seat.share * solid.volume / 8000, 1, 0.1) << seed;
    std::size_t parts = 0;
    for (const CurveBranch& branch : solid.graph.branches) parts += branch.share > 0;
    EXPECT_EQ(parts, 6U) << seed;
  }
}

}  // namespace
}  // namespace affskel::core
