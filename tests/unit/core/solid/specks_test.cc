#include "core/solid/specks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/shapes/shapes.h"
#include "core/solid/made_solid.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Four triangles without volume.
Mesh flat_speck() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(Specks, LeavesSpecksBesideABodyOut) {
  const Mesh body = make_box(3, 2, 1, 2);
  const Solid alone = make_solid(body);
  const Mesh tiny = moved(make_tetrahedron(1), {}, 1e-6);
  for (const Mesh& speck : {flat_speck(), reversed(flat_speck()), tiny}) {
    for (const bool first : {true, false}) {
      const Mesh beside = moved(speck, {-5, 0, 0});
      const Mesh mesh = first ? joined(beside, body) : joined(body, beside);
      std::vector<std::uint32_t> lines;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) lines.push_back(100 + t);
      const Solid solid = make_solid(mesh, {}, {}, lines);
      EXPECT_EQ(solid.mesh.points, alone.mesh.points);
      EXPECT_EQ(solid.mesh.triangles, alone.mesh.triangles);
      EXPECT_EQ(solid.bbox_min, alone.bbox_min);
      EXPECT_EQ(solid.exponent, alone.exponent);
      EXPECT_EQ(solid.volume, alone.volume);
      EXPECT_EQ(solid.solid_volume, alone.solid_volume);
      EXPECT_EQ(solid.shells.size(), 1U);
      ASSERT_EQ(solid.notes.size(), 1U);
      EXPECT_EQ(solid.notes[0].code, "specks");
      EXPECT_EQ(solid.notes[0].severity, MeshNote::Severity::kWarning);
      const std::size_t place = first ? 0 : body.triangles.size();
      EXPECT_NE(solid.notes[0].message.find("1 of 2 solids (4 triangles)"), std::string::npos);
      EXPECT_NE(solid.notes[0].message.find("triangle " + std::to_string(place) + " (line " +
                                            std::to_string(100 + place) + ")"),
                std::string::npos)
          << solid.notes[0].message;
      EXPECT_NE(solid.notes[0].message.find("left out"), std::string::npos);
      EXPECT_NE(refusal(mesh, false), "");
    }
  }
}

TEST(Specks, RefusesSpecksWhenItMustNotRepair) {
  const std::string cause = refusal(joined(make_box(3, 2, 1), flat_speck()), false);
  EXPECT_NE(cause.find("1 of 2 solids (4 triangles)"), std::string::npos) << cause;
  EXPECT_NE(cause.find("triangle 12"), std::string::npos) << cause;
  EXPECT_NE(cause.find("repair is off"), std::string::npos) << cause;
}

TEST(Specks, TellsOfSpecksAndOfTheRestOnce) {
  Mesh mesh = joined(joined(flat_speck(), reversed(make_box(3, 2, 1))), moved(flat_speck(), {9, 9, 9}));
  mesh.points.push_back({50, 0, 0});
  const Solid solid = make_solid(mesh);
  EXPECT_EQ(solid.bbox_max, (Vec3{3, 2, 1}));
  std::vector<std::string> codes;
  for (const MeshNote& note : solid.notes) codes.push_back(note.code);
  EXPECT_EQ(codes, (std::vector<std::string>{"unused-vertices", "specks", "turned-out"}));
  EXPECT_NE(solid.notes[0].message.find("1 vertex "), std::string::npos);
  EXPECT_NE(solid.notes[1].message.find("2 of 3 solids (8 triangles)"), std::string::npos);
}

TEST(Specks, KeepsSolidsThatAreSmallOnlyBesideTheSpecksDistance) {
  const Mesh body = make_box(1, 1, 1), small = moved(make_box(0.01, 0.01, 0.01), {2, 0, 0});
  const Solid solid = make_solid(joined(joined(body, small), moved(flat_speck(), {1e4, 0, 0})));
  ASSERT_EQ(solid.solid_volume.size(), 2U);
  EXPECT_NEAR(solid.solid_volume[1], 1e-6, 1e-15);
  EXPECT_EQ(solid.bbox_max.x, 2.01);
  // Two small ones, each on its side: one of them would stay, but not both.
  const Mesh one = moved(make_box(1e-4, 1e-4, 1e-4), {15, 0, 0}), other = moved(one, {-30, 0, 0});
  const Solid rest = make_solid(joined(joined(body, one), other));
  EXPECT_EQ(rest.bbox_max.x, 1);
}

TEST(Specks, RefusesWhatIsNothingButSpecksOrThinnerThanRounding) {
  EXPECT_NE(refusal(flat_speck()).find("no volume"), std::string::npos);
  EXPECT_NE(refusal(joined(flat_speck(), moved(flat_speck(), {2, 0, 0}))).find("no volume"),
            std::string::npos);
  const Mesh cube = moved(make_box(2, 2, 2), {-1, -1, -1});
  const Mesh skin = joined(cube, moved(reversed(cube), {}, std::nextafter(1.0, 0.0)));
  EXPECT_NE(refusal(skin).find("no volume"), std::string::npos);
  const Mesh cubes = joined(moved(cube, {5, 0, 0}), moved(cube, {-5, 0, 0}));
  EXPECT_NE(refusal(joined(skin, cubes)).find("solid 0 of 3"), std::string::npos);
}

// Noise of this size folds the surface over: most of the time goes into looking for its self-intersections.
// As of the body alone, bit for bit, and so is all that is made of it.
void expect_same_solid(const Solid& solid, const Solid& alone) {
  EXPECT_EQ(solid.mesh.points, alone.mesh.points);
  EXPECT_EQ(solid.mesh.triangles, alone.mesh.triangles);
  EXPECT_EQ(solid.centre, alone.centre);
  EXPECT_EQ(solid.exponent, alone.exponent);
  EXPECT_EQ(solid.solid_volume, alone.solid_volume);
}

TEST(Specks, LeavesASpeckFarAwayOut) {
  const Mesh body = shaken(make_torus(0.4, 0.15, 200), 0, 1);
  for (const double distance : {1e5, 1e6, 1e9, 1e12}) {
    const Vec3 away = distance * Vec3{0.31, -0.7, 0.9};
    for (const double size : {1e-6, 1e-3, 0.02}) {
      const Mesh speck = moved(make_tetrahedron(1), {}, size);
      for (const Mesh& there : {body, moved(body, away)}) {
        const Solid alone = make_solid(there);
        const Mesh other = there.points == body.points ? moved(speck, away) : speck;
        for (const Mesh& mesh : {joined(there, other), joined(reversed(other), there)}) {
          const Solid solid = make_solid(mesh);
          expect_same_solid(solid, alone);
          EXPECT_TRUE(has_note(solid, "specks")) << distance << " " << size;
          EXPECT_NE(refusal(mesh, false).find("1 of 2 solids (4 triangles)"), std::string::npos);
        }
      }
    }
  }
}

TEST(Specks, KeepsSolidsNearTheBodyWhenASpeckIsFarAway) {
  const Mesh small = moved(make_box(0.01, 0.01, 0.01), {2, 0, 0}),
             other = moved(make_box(1, 1, 0.5), {0, 2, 0});
  const Mesh body = joined(joined(small, make_box(1, 1, 1)), other);
  const Mesh speck = moved(make_box(1e-3, 1e-3, 1e-3), {3e6, -1e6, 2e6});
  expect_same_solid(make_solid(joined(speck, body)), make_solid(body));
  // Far away, but together no less than the body: no specks.
  const std::string cause = refusal(joined(body, moved(body, {3e6, -1e6, 2e6})));
  EXPECT_NE(cause.find("too far apart"), std::string::npos) << cause;
}

}  // namespace
}  // namespace affskel::core
