#include "core/ridge/ridge_joins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"
#include "core/chords/chord_fields.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/solid_parts.h"
#include "core/ridge/ridge_meshes.h"
#include "core/ridge/row_band.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid_membership.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

std::array<Vec3, 3> axes(double h) {
  return {Vec3{h, 0, 0}, Vec3{0, h, 0}, Vec3{0, 0, h}};
}

struct Joined {
  explicit Joined(const ErodedSolid& eroded)
      : solid(eroded), parts(solid.solid, solid.lattice), membership(solid.solid.mesh) {}

  // A triangle smaller than the spacing, about the sample point that is nearest to a place of the mesh.
  void add_piece(const Vec3& place) {
    const double h = solid.lattice.spacing;
    SheetVertex vertex;
    double nearest = std::numeric_limits<double>::infinity();
    for_each_point(solid.lattice, [&](int i, int j, int k, std::uint32_t rank) {
      const Vec3 at = h * Vec3{double(i), double(j), double(k)};
      const double away = norm(solid.place(at) - place);
      if (away >= nearest) return;
      nearest = away;
      vertex.point = rank;
      vertex.position = at;
    });
    vertex.area = std::numbers::pi;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& by : {Vec3{}, Vec3{0.1 * h, 0, 0}, Vec3{0, 0.1 * h, 0}}) {
      mesh.vertices.push_back(vertex);
      mesh.vertices.back().position = vertex.position + by;
      mesh.part.push_back(parts.of_point(vertex.point));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }

  std::uint32_t join(double max_length) {
    const auto inside = [&](const Vec3& u) {
      return membership.contains(scaled_place(solid.lattice, (1 / solid.lattice.spacing) * u));
    };
    return join_pieces(mesh, solid.lattice, solid.field, inside, {max_length});
  }

  double length() const {
    double sum = 0;
    for (const Segment& s : mesh.segments)
      sum += norm(mesh.vertices[s[1]].position - mesh.vertices[s[0]].position);
    return sum;
  }

  const ErodedSolid& solid;
  SolidParts parts;
  SolidMembership membership;
  SheetMesh mesh;
};

TEST(RidgeJoins, LeadThroughTheSolidAndNoFartherThanAsked) {
  const ErodedSolid torus(make_torus(3, 1, 256), axes(0.2), "triangles");
  Joined joined(torus);
  joined.add_piece({3, 0, 0});
  joined.add_piece({0, 3, 0});
  EXPECT_EQ(joined.join(3), 0U);  // radii of 1: a quarter of the inner circle is 3.14 long
  EXPECT_TRUE(joined.mesh.segments.empty());
  EXPECT_EQ(joined.join(6), 1U);
  EXPECT_EQ(topology(joined.mesh).betti, (BettiNumbers{1, 0, 0}));
  EXPECT_GT(joined.length(), std::numbers::pi);
  EXPECT_LT(joined.length(), 1.5 * std::numbers::pi);  // that of the middle circle
  for (const Segment& s : joined.mesh.segments) {
    const Vec3 x = torus.place(joined.mesh.vertices[s[1]].position);
    EXPECT_LT(std::hypot(std::hypot(x.x, x.y) - 3, x.z), 1);
  }
  EXPECT_EQ(joined.join(6), 0U);  // one piece now
}

TEST(RidgeJoins, KeepToWhereEIsLarge) {
  const ErodedSolid box(make_box(8, 2, 2, 1), axes(0.25), "sphere:320");
  Joined joined(box);
  joined.add_piece({1, 0.5, 0.5});
  joined.add_piece({7, 0.5, 0.5});
  EXPECT_EQ(joined.join(10), 1U);
  std::size_t met = 0;
  for (const SheetVertex& v : joined.mesh.vertices) {
    const Vec3 x = box.place(v.position);
    if (std::abs(x.x - 4) > 1) continue;
    ++met;
    EXPECT_NEAR(x.y, 1, 0.3);
    EXPECT_NEAR(x.z, 1, 0.3);
    EXPECT_TRUE(std::isfinite(v.area) && v.area > 0);
  }
  EXPECT_GE(met, 6U);
}

TEST(RidgeJoins, AreAsFewAsJoinAllPieces) {
  const ErodedSolid box(make_box(8, 2, 2, 1), axes(0.25), "sphere:320");
  Joined joined(box);
  for (const double x : {1.0, 3.0, 5.0, 7.0}) joined.add_piece({x, 1, 1});
  EXPECT_EQ(joined.join(3), 3U);
  EXPECT_EQ(topology(joined.mesh).betti, (BettiNumbers{1, 0, 0}));
  EXPECT_NEAR(joined.length(), 6, 0.5);
}

TEST(RidgeJoins, DoNotLeaveTheirPart) {
  const Mesh one = make_box(3, 2, 2, 1);
  const ErodedSolid boxes(joined(one, moved(one, {3.5, 0, 0})), axes(0.25), "sphere:320");
  Joined joined(boxes);
  joined.add_piece({2.5, 1, 1});
  joined.add_piece({4, 1, 1});
  EXPECT_EQ(joined.join(100), 0U);
  joined.add_piece({0.5, 1, 1});
  EXPECT_EQ(joined.join(100), 1U);
  EXPECT_EQ(topology(joined.mesh).betti.components, 2);
}

}  // namespace
}  // namespace affskel::core
