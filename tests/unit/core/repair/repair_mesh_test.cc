#include "core/repair/repair_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/split_mix64.h"
#include "core/mesh/perturb.h"
#include "core/mesh/unused_points.h"
#include "core/repair/fill_holes.h"
#include "core/repair/repaired.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/solid/surface_samples.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Each triangle by itself, which no step joins.
TEST(RepairMesh, WrapsABoxOfLooseTriangles) {
  const Mesh box = make_box(2, 2, 2, 4);
  SplitMix64 random(1);
  const auto jitter = [&] { return 1e-4 * static_cast<double>(random.next() % 1000) / 1000; };
  Mesh loose, half;  // half: those on one side of the middle hang together
  for (const Triangle& t : box.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.points.size());
    const bool is_low = box.points[t[0]].z + box.points[t[1]].z + box.points[t[2]].z < 2;
    for (const std::uint32_t v : t) {
      loose.points.push_back(box.points[v] + Vec3{jitter(), jitter(), jitter()});
      half.points.push_back(is_low ? box.points[v] : loose.points.back());
    }
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  half.triangles = loose.triangles;
  for (const Mesh& mesh : {loose, half}) {
    const std::string left = repair_mesh(mesh).left;
    EXPECT_NE(left.find(" parts do not hang together by edges"), std::string::npos) << left;
  }
  for (const Mesh& mesh : {loose, half})
    EXPECT_NEAR(repair_mesh(mesh, {.kind = RepairKind::kWrap, .alpha = 0.2}).volume, 8, 0.04);
  const Mesh strip{{{0, 0, 0}, {100, 0, 0}, {100, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_THROW(repair_mesh(joined(strip, moved(strip, {0, 0, 5})), {.kind = RepairKind::kWrap}), CoreError);
  // Two sheets with nothing between them.
  const Mesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_THROW(repair_mesh(joined(sheet, moved(sheet, {0, 0, 1})), {.kind = RepairKind::kWrap}), CoreError);
}

TEST(RepairMesh, DropsFlapsThatAreLongerRoundThanHolesMayBe) {
  const auto with_fin = [](double side) {
    return joined(make_box(2, 2, 2), {{{0, 0, 0}, {0, 0, 2}, {side, side, 3}}, {{0, 1, 2}}});
  };
  const RepairedMesh repaired = repair_mesh(with_fin(3));
  EXPECT_EQ(repaired.left, "");
  ASSERT_NE(step(repaired, "flaps"), nullptr);
  EXPECT_NEAR(repaired.volume, 8, 1e-12);
  EXPECT_NE(repair_mesh(with_fin(9)).left, "") << "a side of something";
}

TEST(RepairMesh, PointsThatNothingUsesLengthenNoHole) {
  Mesh open = make_box(1, 1, 1);
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2);
  const std::string left = repair_mesh(open).left;
  EXPECT_NE(left, "");
  open.points.push_back({50, 0, 0});
  EXPECT_EQ(repair_mesh(open).left, left);
}

TEST(RepairMesh, LeavesASoundMeshAsItIs) {
  const Mesh body = make_body();
  const RepairedMesh repaired = repair_mesh(body);
  EXPECT_TRUE(repaired.steps.empty());
  EXPECT_TRUE(repaired.left.empty());
  EXPECT_EQ(repaired.mesh.points.size(), body.points.size());
  EXPECT_EQ(volume_of(repaired.mesh), volume_of(body));
}

// So many triangles at a point took minutes, and would time out.
TEST(RepairMesh, LeavesAConeOfManyTrianglesAsItIs) {
  const Mesh cone = make_cone(3, 2, 200'000);
  const RepairedMesh repaired = repair_mesh(cone, {});
  EXPECT_EQ(repaired.mesh.points, cone.points);
  EXPECT_EQ(repaired.mesh.triangles, cone.triangles);
}

TEST(RepairMesh, RefusesAWrapThatWouldBeABox) {
  const Mesh box = make_box(3, 2, 1);
  EXPECT_EQ(repair_mesh(box, {.kind = RepairKind::kWrap, .alpha = 3}).left, "");
  for (const double alpha : {4.0, 1e300})
    EXPECT_THROW(repair_mesh(box, {.kind = RepairKind::kWrap, .alpha = alpha}), CoreError);
}

// A side that is divided beside ones that are not.
TEST(RepairMesh, JoinsAtTJunctions) {
  const auto has_z = [](const Mesh& mesh, const Triangle& t, double z) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return mesh.points[v].z == z; });
  };
  for (const std::uint32_t divisions : {2U, 3U, 7U}) {
    Mesh box = make_box(1, 2, 3), divided = make_box(1, 2, 3, divisions);
    std::erase_if(box.triangles, [&](const Triangle& t) { return has_z(box, t, 3); });
    std::erase_if(divided.triangles, [&](const Triangle& t) { return !has_z(divided, t, 3); });
    const auto first = static_cast<std::uint32_t>(box.points.size());
    box.points.insert(box.points.end(), divided.points.begin(), divided.points.end());
    for (const Triangle& t : divided.triangles)
      box.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    const RepairedMesh repaired = repair_mesh(box);
    EXPECT_TRUE(repaired.left.empty()) << repaired.left;
    ASSERT_NE(step(repaired, "t-junctions"), nullptr);
    EXPECT_EQ(step(repaired, "t-junctions")->count, 4 * (divisions - 1));
    EXPECT_EQ(step(repaired, "filled-holes"), nullptr);
    EXPECT_NEAR(volume_of(repaired.mesh), 6, 1e-12);
    EXPECT_TRUE(make_solid(repaired.mesh).notes.empty());
  }
}

TEST(RepairMesh, FillsPlaneHolesWithPlanes) {
  Mesh box = make_box(1, 2, 3, 4);
  std::erase_if(box.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return box.points[v].z == 3; });
  });
  const RepairedMesh repaired = repair_mesh(box, {.longest_hole = 7});
  EXPECT_NEAR(volume_of(repaired.mesh), 6, 1e-12);
  ASSERT_NE(step(repaired, "filled-holes"), nullptr);
  EXPECT_EQ(step(repaired, "filled-holes")->count, 1u);
  EXPECT_NEAR(repaired.filled_share, 2.0 / 22, 1e-12);
}

TEST(RepairMesh, FillsRoundHolesRound) {
  const Mesh ball = make_sphere(10, 5120);
  const Mesh open = cut(ball, {0, 0, 10}, 4);
  ASSERT_LT(open.triangles.size(), ball.triangles.size() - 100);
  const RepairedMesh repaired = repair_mesh(open, {.longest_hole = 30});
  // A plane lid would lack a cap of height 0.8 and volume 19.6 of 4,180; a faired one has most of it.
  EXPECT_NEAR(volume_of(repaired.mesh) / volume_of(ball), 1, 0.002);
}

// A soap film in a ball's hole is plane, and lacks the cap.
TEST(RepairMesh, TellsHowMuchFillingsHoldBeyondFilms) {
  const Mesh ball = make_sphere(10, 5120), open = cut(ball, {0, 0, 10}, 6);
  const RepairedMesh repaired = repair_mesh(open, {.longest_hole = 50});
  const double height = (surface_area(ball) - surface_area(open)) / (2 * M_PI * 10);
  EXPECT_NEAR(repaired.bulge / (M_PI * height * height * (10 - height / 3)), 1, 0.1);
  ASSERT_NE(step(repaired, "bent-fillings"), nullptr);
  EXPECT_EQ(step(repair_mesh(cut(ball, {0, 0, 10}, 2), {.longest_hole = 50}), "bent-fillings"), nullptr);
}

TEST(RepairMesh, BodiesWithManyHolesKeepTheirVolume) {
  const Mesh body = make_body({.triangles = 5000});
  for (const std::uint64_t seed : {1, 2, 3}) {
    SplitMix64 random(seed);
    Mesh open = body;
    const double area = surface_area(body);
    for (int hole = 0; hole < 40 && surface_area(open) > 0.95 * area; ++hole)
      open = cut(open, body.points[random.next() % body.points.size()], 60);
    ASSERT_LT(surface_area(open), 0.99 * area);
    const RepairedMesh repaired = repair_mesh(open);
    EXPECT_TRUE(repaired.left.empty()) << repaired.left;
    EXPECT_NEAR(volume_of(repaired.mesh) / volume_of(body), 1, 0.005) << seed;
  }
}

TEST(RepairMesh, LeavesHolesThatAreTooLongAndSaysWhere) {
  const Mesh open = cut(make_sphere(10, 1280), {0, 0, 10}, 8);
  const RepairedMesh repaired = repair_mesh(open, {.longest_hole = 20});
  EXPECT_NE(repaired.left.find("1 hole is left, the longest 4"), std::string::npos) << repaired.left;
  EXPECT_THROW(make_solid(repaired.mesh), CoreError);
}

TEST(RepairMesh, OffersNoLengthForAHoleOfTooManyEdges) {
  Mesh open = make_cone(3, 2, kMaxHoleEdges + 1);
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return open.points[v].z == 0; });
  });
  const RepairedMesh repaired = repair_mesh(open, {.longest_hole = 1});
  EXPECT_NE(repaired.left.find("of 20001 edges, more than can be filled"), std::string::npos)
      << repaired.left;
  EXPECT_EQ(repaired.longest_left, 0);
}

TEST(RepairMesh, WeldsSeparatesAndDropsWhatIsTooMuch) {
  // Every triangle with corners of its own, half of them turned over, one twice, one degenerate, a point unused, and a
  // fin on an edge.
  const Mesh ball = make_sphere(10, 320);
  Mesh soup;
  for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t v : ball.triangles[t]) soup.points.push_back(ball.points[v]);
    soup.triangles.push_back(t % 2 == 0 ? Triangle{first, first + 1, first + 2}
                                        : Triangle{first, first + 2, first + 1});
  }
  soup.triangles.push_back(soup.triangles[5]);
  soup.triangles.push_back({0, 0, 1});
  soup.points.push_back({50, 0, 0});
  soup.points.push_back(2 * soup.points[0]);
  soup.triangles.push_back({0, 1, static_cast<std::uint32_t>(soup.points.size() - 1)});
  const RepairedMesh repaired = repair_mesh(soup);
  EXPECT_TRUE(repaired.left.empty()) << repaired.left;
  EXPECT_NEAR(std::fabs(volume_of(repaired.mesh)), volume_of(ball), 1e-9);
  for (const char* code :
       {"welded-points", "unused-points", "degenerate-triangles", "repeated-triangles", "flaps"})
    EXPECT_NE(step(repaired, code), nullptr) << code;
}

// Every triangle with corners of its own, rounded another way each time; steps of ten times as much stay open.
TEST(RepairMesh, JoinsCornersThatRoundingHasParted) {
  const Mesh ball = make_sphere(10, 320);
  const auto parted = [&](double step) {
    Mesh soup;
    for (const Triangle& t : ball.triangles) {
      const auto first = static_cast<std::uint32_t>(soup.points.size());
      for (const std::uint32_t v : t)
        soup.points.push_back(ball.points[v] + step * Vec3{double(first % 7) - 3, double(first % 5) - 2, 1});
      soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
  };
  const RepairedMesh repaired = repair_mesh(parted(1e-6));
  EXPECT_TRUE(repaired.left.empty()) << repaired.left;
  EXPECT_EQ(repaired.mesh.points.size(), ball.points.size());
  EXPECT_NEAR(volume_of(repaired.mesh), volume_of(ball), 1e-2);
  ASSERT_NE(step(repaired, "joined-points"), nullptr);
  EXPECT_GT(step(repaired, "joined-points")->count, 700U);
  EXPECT_EQ(step(repaired, "filled-holes"), nullptr);
  EXPECT_EQ(step(repair_mesh(parted(1e-3)), "joined-points"), nullptr);
}

// A hole of many edges, or a wrap, takes seconds by itself.
TEST(RepairMesh, StopsWithinAHole) {
  const Mesh open = cut(make_sphere(10, 20'480), {0, 0, 10}, 2);
  expect_stops_wherever_it_is_asked(
      50, [&](ExecutionContext* context) { repair_mesh(open, {.context = context}); });
}

TEST(RepairMesh, StopsWithinAWrap) {
  const Mesh open = cut(make_body(), {0, 0, 0}, 50);
  expect_stops_wherever_it_is_asked(1000, [&](ExecutionContext* context) {
    repair_mesh(open, {.kind = RepairKind::kWrap, .alpha = 60, .context = context});
  });
}

TEST(RepairMesh, PointsAreWrapped) {
  const Mesh ball = make_sphere(10, 320);
  Mesh points;
  points.points = surface_samples(ball, 8000);
  const RepairedMesh repaired = repair_mesh(points, {.kind = RepairKind::kWrap, .alpha = 2});
  EXPECT_NEAR(volume_of(repaired.mesh) / volume_of(ball), 1, 0.02);
  EXPECT_EQ(repair_mesh(points).left, "there are points and no triangles");
}

// A cavity that touches a notch along an edge: the cells of a cube of 27, two of them empty.
TEST(RepairMesh, KeepsACavityThatTouchesTheOutsideAlongAnEdge) {
  const auto empty = [](int x, int y, int z) {
    return x < 0 || y < 0 || z < 0 || x > 2 || y > 2 || z > 2 || (x == 1 && y == z && y > 0);
  };
  Mesh mesh;
  for (int i = 0; i < 64; ++i) mesh.points.push_back({double(i / 16), double(i / 4 % 4), double(i % 4)});
  for (int cell = 0; cell < 27; ++cell) {
    const std::array<int, 3> at{cell / 9, cell / 3 % 3, cell % 3};
    if (empty(at[0], at[1], at[2])) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int ahead : {0, 1}) {
        std::array<int, 3> beside = at;
        beside[axis] += ahead == 1 ? 1 : -1;
        if (!empty(beside[0], beside[1], beside[2])) continue;
        std::array<std::uint32_t, 4> round{};
        for (std::size_t n = 0; n < 4; ++n) {
          std::array<int, 3> corner = at;
          corner[axis] += ahead;
          corner[(axis + 1) % 3] += n == 1 || n == 2 ? 1 : 0;
          corner[(axis + 2) % 3] += n >= 2 ? 1 : 0;
          round[n] = static_cast<std::uint32_t>(16 * corner[0] + 4 * corner[1] + corner[2]);
        }
        if (ahead == 0) std::swap(round[1], round[3]);
        mesh.triangles.push_back({round[0], round[1], round[2]});
        mesh.triangles.push_back({round[0], round[2], round[3]});
      }
    }
  }
  const RepairedMesh repaired = repair_mesh(mesh);
  EXPECT_EQ(repaired.left, "");
  EXPECT_NEAR(repaired.volume, 25, 1e-12);
}

// A loose triangle in the corner of a box: filled, it is two triangles on each other that share a vertex with the box.
TEST(RepairMesh, DropsFlapsThatHangOnAVertex) {
  Mesh mesh = make_box(1, 1, 1);
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.push_back({2, 0, 0});
  mesh.points.push_back({2, 1, 0});
  mesh.triangles.push_back({mesh.triangles[0][0], first, first + 1});
  const RepairedMesh repaired = repair_mesh(mesh, {.longest_hole = 10});
  EXPECT_EQ(repaired.left, "");
  ASSERT_NE(step(repaired, "flaps"), nullptr);
  EXPECT_NEAR(repaired.volume, 1, 1e-12);
}

TEST(RepairMesh, WhatIsClosedAndHoldsNothingIsLeft) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
  const RepairedMesh repaired = repair_mesh(mesh);
  EXPECT_NE(repaired.left, "");
  EXPECT_EQ(repaired.volume, 0);
}

TEST(RepairMesh, TurnsWhatDisagrees) {
  Mesh body = make_body();
  const double volume = volume_of(body);
  for (std::size_t t = 0; t < body.triangles.size(); t += 3)
    std::swap(body.triangles[t][0], body.triangles[t][1]);
  const RepairedMesh repaired = repair_mesh(body);
  ASSERT_NE(step(repaired, "turned-triangles"), nullptr);
  EXPECT_EQ(step(repaired, "turned-triangles")->count, (body.triangles.size() + 2) / 3);
  EXPECT_NEAR(volume_of(repaired.mesh), volume, 1e-9 * volume);
}

// Surface by surface: of two balls one, and the wall of a cavity.
TEST(RepairMesh, WhatItWritesEnclosesWhatItTells) {
  const Mesh ball = make_sphere(1, 80), large = make_sphere(3, 320);
  const double small_volume = enclosed_volume(ball), large_volume = enclosed_volume(large);
  const RepairedMesh two = repair_mesh(joined(moved(ball, {9, 0, 0}), reversed(large)));
  EXPECT_NE(step(two, "turned-out"), nullptr);
  EXPECT_NEAR(enclosed_volume(two.mesh), small_volume + large_volume, 1e-9);
  const RepairedMesh hollow = repair_mesh(joined(large, ball));
  EXPECT_NE(step(hollow, "turned-cavities"), nullptr);
  EXPECT_NEAR(enclosed_volume(hollow.mesh), large_volume - small_volume, 1e-9);
  EXPECT_NEAR(enclosed_volume(hollow.mesh), hollow.volume, 1e-9);
  EXPECT_TRUE(repair_mesh(joined(large, reversed(ball))).steps.empty());
}

// It has no side of its own, and is turned with its neighbours.
TEST(RepairMesh, TurnsATriangleWithoutArea) {
  Mesh box = make_box(2, 2, 2);
  const auto [a, b, c] = box.triangles[0];
  const auto middle = static_cast<std::uint32_t>(box.points.size());
  box.points.push_back(0.5 * (box.points[a] + box.points[b]));
  box.triangles[0] = {a, middle, c};
  box.triangles.push_back({middle, b, c});
  box.triangles.push_back({a, b, middle});
  const RepairedMesh repaired = repair_mesh(reversed(box));
  EXPECT_NE(step(repaired, "turned-out"), nullptr);
  EXPECT_EQ(make_solid(repaired.mesh, {.repair = false, .check_self_intersections = false}).volume, 8);
}

TEST(RepairMesh, WrapsBesideTrianglesWithoutArea) {
  Mesh line;
  line.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0.5, 0, 0}, {0, 1, 0}};
  line.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 3, 1}};
  EXPECT_THROW(repair_mesh(line, {.kind = RepairKind::kWrap, .alpha = 0.1}), CoreError);
  line.triangles.push_back({0, 1, 4});
  EXPECT_FALSE(repair_mesh(line, {.kind = RepairKind::kWrap, .alpha = 0.1}).mesh.triangles.empty());
}

TEST(RepairMesh, RefusesWhatCannotBeComputedWith) {
  Mesh ball = make_sphere(1, 80);
  EXPECT_THROW(repair_mesh(ball, {.kind = RepairKind::kWrap, .alpha = 1e-4}), CoreError);
  for (const double scale : {1e100, 1e-100}) {
    Mesh scaled = ball;
    for (Vec3& p : scaled.points) p = scale * p;
    EXPECT_THROW(repair_mesh(scaled), CoreError) << scale;
    EXPECT_THROW(repair_mesh(scaled, {.kind = RepairKind::kWrap}), CoreError) << scale;
  }
  for (Vec3& p : ball.points) p = {1, 2, 3};
  EXPECT_THROW(repair_mesh(ball, {.kind = RepairKind::kWrap}), CoreError);
  EXPECT_THROW(repair_mesh({}), CoreError);
}

}  // namespace
}  // namespace affskel::core
