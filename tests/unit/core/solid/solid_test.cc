#include "core/solid/solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/mesh/perturb.h"
#include "core/mesh_checks.h"
#include "core/shapes/shapes.h"
#include "core/solid/made_solid.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

TEST(MakeSolid, MeasuresABox) {
  const Solid solid = make_solid(moved(make_box(3, 2, 1), {100, -50, 7}));
  EXPECT_NEAR(solid.volume, 6, 6e-12);
  EXPECT_EQ(solid.shells.size(), 1U);
  EXPECT_EQ(solid.shells[0].genus, 0);
  EXPECT_EQ(solid.bbox_min, (Vec3{100, -50, 7}));
  EXPECT_EQ(solid.bbox_max, (Vec3{103, -48, 8}));
  EXPECT_TRUE(solid.notes.empty());
}

TEST(MakeSolid, InnerCoordinatesFillTheUnitBox) {
  for (double scale : {1.0, 1e-9, 3e7, 1e90}) {
    const Solid solid = make_solid(make_box(3 * scale, 2 * scale, scale));
    double largest = 0;
    for (const Vec3& p : solid.mesh.points) largest = std::max(largest, std::abs(p.x));
    EXPECT_GT(2 * largest, 0.5);
    EXPECT_LE(2 * largest, 1.0);
    EXPECT_NEAR(solid.scale() * 2 * largest / (3 * scale), 1, 1e-14);
  }
}

TEST(MakeSolid, KeepsPrecisionFarFromTheOrigin) {
  const double exact = make_solid(make_sphere(1, 320)).volume;
  EXPECT_NEAR(make_solid(moved(make_sphere(1, 320), {1e6, 1e6, -1e6})).volume / exact, 1, 1e-9);
}

TEST(MakeSolid, CountsHandles) {
  EXPECT_EQ(make_solid(make_torus(3, 1, 256)).shells[0].genus, 1);
}

TEST(MakeSolid, FindsCavitiesAndTheirSolids) {
  const Mesh hollow = joined(make_sphere(3, 320), reversed(make_sphere(1, 80)));
  const Mesh mesh = joined(joined(hollow, moved(make_box(1, 1, 1), {10, 0, 0})), make_sphere(0.5, 20));
  const Solid solid = make_solid(mesh);
  ASSERT_EQ(solid.shells.size(), 4U);
  ASSERT_EQ(solid.solid_volume.size(), 3U);
  EXPECT_TRUE(solid.shells[1].cavity);
  EXPECT_EQ(solid.shells[1].solid, solid.shells[0].solid);
  EXPECT_FALSE(solid.shells[3].cavity);  // a core floating in the cavity is a solid of its own
  EXPECT_NEAR(solid.solid_volume[0], mesh_facts(hollow).volume, 1e-10);
  EXPECT_NEAR(solid.solid_volume[1], 1, 1e-12);
  EXPECT_NEAR(solid.volume, mesh_facts(mesh).volume, 1e-10);
  EXPECT_TRUE(solid.notes.empty());
}

TEST(MakeSolid, TurnsWhatFacesInward) {
  const Solid solid = make_solid(reversed(make_sphere(1, 80)));
  EXPECT_TRUE(has_note(solid, "turned-out"));
  EXPECT_NEAR(solid.volume, mesh_facts(make_sphere(1, 80)).volume, 1e-12);
  EXPECT_GT(mesh_facts(solid.mesh).volume, 0);
  // A hollow ball inside out: both surfaces are turned.
  const Mesh hollow = joined(make_sphere(3, 320), reversed(make_sphere(1, 80)));
  EXPECT_NEAR(make_solid(reversed(hollow)).volume, mesh_facts(hollow).volume, 1e-10);
  // Both surfaces outward: the inner one becomes the cavity's wall.
  const Solid outward = make_solid(joined(make_sphere(3, 320), make_sphere(1, 80)));
  EXPECT_NEAR(outward.volume, mesh_facts(hollow).volume, 1e-10);
  EXPECT_TRUE(has_note(outward, "turned-cavities"));
  EXPECT_FALSE(has_note(outward, "turned-out"));
}

TEST(MakeSolid, NamesCopies) {
  const Mesh ball = make_sphere(1, 80);
  Mesh shuffled = ball;
  std::reverse(shuffled.triangles.begin(), shuffled.triangles.end());
  EXPECT_TRUE(has_note(make_solid(joined(ball, shuffled)), "copies"));
  EXPECT_FALSE(has_note(make_solid(joined(ball, moved(ball, {0.5, 0, 0}))), "copies"));
}

TEST(MakeSolid, MakesFacesAgreeByTurningTheFewerOnes) {
  Mesh mesh = make_torus(3, 1, 256);
  for (std::size_t t : {3U, 4U, 77U, 200U}) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const Solid solid = make_solid(mesh);
  EXPECT_TRUE(has_note(solid, "reoriented"));
  EXPECT_FALSE(has_note(solid, "turned-out"));
  expect_solid_boundary(solid.mesh, 1);
  EXPECT_NE(refusal(mesh, false).find("triangle 3"), std::string::npos);
}

TEST(MakeSolid, WeldsSeamsAndDropsUnusedVertices) {
  const Mesh whole = make_sphere(1, 80);
  Mesh soup;
  for (const Triangle& t : whole.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (std::uint32_t v : t) soup.points.push_back(whole.points[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.points.push_back({1e9, 0, 0});
  const Solid solid = make_solid(soup);
  EXPECT_TRUE(has_note(solid, "welded"));
  EXPECT_TRUE(has_note(solid, "unused-vertices"));
  EXPECT_EQ(solid.mesh.points.size(), whole.points.size());
  EXPECT_NEAR(solid.volume, mesh_facts(whole).volume, 1e-12);
  EXPECT_NE(refusal(soup, false), "");
}

TEST(MakeSolid, LeavesOutTrianglesThatNameAVertexTwice) {
  const Mesh whole = make_sphere(1, 80);
  Mesh mesh = whole;
  const auto [a, b, c] = mesh.triangles[7];
  mesh.triangles.insert(mesh.triangles.begin() + 3, {{a, b, a}, {b, a, b}, {c, c, c}});
  const Solid solid = make_solid(mesh);
  EXPECT_TRUE(has_note(solid, "degenerate-triangles"));
  EXPECT_EQ(solid.mesh.triangles, make_solid(whole).mesh.triangles);
  EXPECT_EQ(solid.volume, make_solid(whole).volume);
  EXPECT_NE(
      refusal(mesh, false).find("3 triangles with the same vertex at two corners, the first: triangle 3"),
      std::string::npos);
  EXPECT_NE(refusal({whole.points, {{0, 1, 0}, {1, 2, 2}}}).find("bounds no volume"), std::string::npos);
}

TEST(MakeSolid, RefusesVolumesBeyondNumbers) {
  EXPECT_NE(refusal(make_box(1e150, 1e-150, 1)).find("has a volume out of range"), std::string::npos);
}

TEST(MakeSolid, SplitsVerticesWhereSurfacesTouch) {
  // Two boxes that share one corner vertex.
  Mesh mesh = joined(make_box(1, 1, 1), moved(make_box(1, 1, 1), {1, 1, 1}));
  const auto at = [&](std::size_t from) {
    for (std::size_t v = from; v < mesh.points.size(); ++v) {
      if (mesh.points[v] == Vec3{1, 1, 1}) return static_cast<std::uint32_t>(v);
    }
    return 0U;
  };
  const std::uint32_t first = at(0), second = at(first + 1);
  for (Triangle& t : mesh.triangles) std::replace(t.begin(), t.end(), second, first);
  const Solid solid = make_solid(mesh);
  EXPECT_TRUE(has_note(solid, "split-vertices"));
  EXPECT_EQ(solid.solid_volume.size(), 2U);
  EXPECT_TRUE(mesh_facts(solid.mesh).vertices_manifold);
}

// Vertices are welded, and unused ones left out, before an edge is found to be open.
TEST(MakeSolid, NamesTheEdgesOfTheInput) {
  const Mesh whole = make_tetrahedron(1);
  Mesh open;
  open.points.assign(7, {9, 9, 9});
  for (std::size_t t = 0; t < 3; ++t) {
    const auto first = static_cast<std::uint32_t>(open.points.size());
    for (const std::uint32_t v : whole.triangles[t]) open.points.push_back(whole.points[v]);
    open.triangles.push_back({first, first + 1, first + 2});
  }
  const std::string message = refusal(open);
  bool named = false;
  for (std::uint32_t t = 0; t < 3; ++t) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t a = 7 + 3 * t + c, b = 7 + 3 * t + (c + 1) % 3;
      const std::uint32_t low = std::min(a, b), high = std::max(a, b);
      named |= message.find("vertices " + std::to_string(low) + " and " + std::to_string(high) +
                            ", triangle " + std::to_string(t)) != std::string::npos;
    }
  }
  EXPECT_TRUE(named) << message;
}

TEST(MakeSolid, RefusesWhatBoundsNoSolidAndSaysWhere) {
  Mesh open = make_sphere(1, 80);
  open.triangles.pop_back();
  EXPECT_NE(refusal(open).find("3 open edges"), std::string::npos);
  EXPECT_NE(refusal(open).find("fill its holes first"), std::string::npos);
  Mesh twice = make_sphere(1, 80);
  twice.triangles.push_back(twice.triangles[5]);
  EXPECT_NE(refusal(twice).find("triangle 5 and triangle 80 are the same"), std::string::npos);
  Mesh fin = make_box(1, 1, 1);
  fin.points.push_back({5, 5, 5});
  fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], 8});
  EXPECT_NE(refusal(fin).find("more than two triangles"), std::string::npos);
  EXPECT_NE(refusal({}).find("no triangles"), std::string::npos);
  Mesh flat = make_box(1, 1, 1);
  for (Vec3& p : flat.points) p.z = 0;
  EXPECT_NE(refusal(flat).find("no volume"), std::string::npos);
  Mesh point = make_box(1, 1, 1);
  for (Vec3& p : point.points) p = {1, 2, 3};
  EXPECT_NE(refusal(point).find("one place"), std::string::npos);
  EXPECT_NE(refusal(make_box(1e160, 1e160, 1e160)).find("too large"), std::string::npos);
  EXPECT_NE(refusal(make_box(1e-104, 1e-104, 1e-104)).find("too small"), std::string::npos);
}

TEST(MakeSolid, RefusesAKleinBottle) {
  // A 4 x 4 grid on the square, one pair of sides glued straight, the other reversed.
  Mesh mesh;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      mesh.points.push_back({std::cos(i + 0.3 * j), std::sin(2 * i + j), 0.1 * i * j});
  }
  const auto vertex = [](int i, int j) {
    const bool twisted = i == 4;
    return static_cast<std::uint32_t>((i % 4) * 4 + (twisted ? (8 - j) % 4 : j % 4));
  };
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
      mesh.triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  EXPECT_NE(refusal(mesh).find("not orientable"), std::string::npos);
}

TEST(MakeSolid, WarnsOfSurfacesThatCrossThemselves) {
  const Solid solid = make_solid(joined(make_box(1, 1, 1), moved(make_box(1, 1, 1), {0.5, 0.25, 0.125})));
  EXPECT_TRUE(solid.self_intersecting);
  EXPECT_TRUE(has_note(solid, "self-intersecting"));
  EXPECT_NEAR(solid.volume, 2, 1e-12);
}

TEST(MakeSolid, TellsWhetherDifferentSurfacesMeet) {
  const Mesh box = make_box(2, 2, 2);
  EXPECT_TRUE(make_solid(joined(box, moved(box, {1, 1, 1}))).surfaces_meet);
  EXPECT_TRUE(make_solid(joined(box, moved(box, {2, 1, 1}))).surfaces_meet) << "they touch";
  EXPECT_FALSE(make_solid(joined(box, moved(box, {3, 1, 1}))).surfaces_meet);
  const Solid coil = make_solid(make_coil());
  EXPECT_TRUE(coil.self_intersecting);
  EXPECT_FALSE(coil.surfaces_meet) << "it is one surface";
}

TEST(MakeSolid, StopsWhereverItIsAsked) {
  PerturbOptions noise;
  noise.sigma = 0.01;
  const Mesh mesh = perturb(make_sphere(1, 20480), noise);
  SolidOptions options;
  expect_stops_wherever_it_is_asked(20, [&](ExecutionContext* context) {
    options.context = context;
    make_solid(mesh, options);
  });
}

TEST(MakeSolid, RefusesSolidsTooFarApartAndSaysSo) {
  const Mesh cube = make_box(1, 1, 1);
  for (const double distance : {6e4, 1e6, 1e15}) {
    for (const double side : {0.2, 0.5}) {
      const Mesh mesh = joined(cube, moved(make_box(side, side, side), {0, distance, 0}));
      const std::string cause = refusal(mesh);
      EXPECT_NE(cause.find("too far apart"), std::string::npos) << cause;
      EXPECT_NE(
          cause.find(distance < 1e5 ? "solid 1 of 2, which begins with triangle 12, is " + base::to_text(side)
                                    : "solid 0 of 2, which begins with triangle 0, is 1 long"),
          std::string::npos)
          << cause;
      EXPECT_NE(cause.find("the whole mesh " + base::to_text(distance)), std::string::npos) << cause;
    }
  }
  // Nor is a large skin a speck, although it has no volume.
  const Mesh centred = moved(make_box(2, 2, 2), {-1, -1, -1});
  const Mesh skin = joined(centred, moved(reversed(centred), {}, std::nextafter(1.0, 0.0)));
  EXPECT_NE(refusal(joined(cube, moved(skin, {0, 1e6, 0}))).find("too far apart"), std::string::npos);
}

}  // namespace
}  // namespace affskel::core
