#include "core/chords/chord_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/chords/chord_fields.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/perturb.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid_membership.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

std::array<Vec3, 3> axes(double h, double x = 1, double y = 1, double z = 1) {
  return {Vec3{h * x, 0, 0}, Vec3{0, h * y, 0}, Vec3{0, 0, h * z}};
}

// Counted from the triangles alone.
struct Topology {
  std::int64_t euler = 0;
  std::size_t components = 0;
  std::size_t rims = 0;       // connected sets of edges with one triangle
  std::size_t branching = 0;  // edges with three and more
};

class Union {
 public:
  std::uint32_t find(std::uint32_t i) {
    auto [at, fresh] = parent_.try_emplace(i, i);
    return fresh || at->second == i ? i : at->second = find(at->second);
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }
  std::size_t count() {
    std::set<std::uint32_t> roots;
    for (const auto& [i, p] : std::map(parent_)) roots.insert(find(i));
    return roots.size();
  }

 private:
  std::map<std::uint32_t, std::uint32_t> parent_;
};

Topology topology(const ChordSheet& sheet) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : sheet.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  }
  Union whole, rim;
  Topology result;
  for (const auto& [edge, triangles] : edges) {
    whole.join(edge.first, edge.second);
    if (triangles == 1) rim.join(edge.first, edge.second);
    result.branching += triangles > 2 ? 1 : 0;
  }
  result.euler = static_cast<std::int64_t>(sheet.vertices.size() + sheet.triangles.size()) -
                 static_cast<std::int64_t>(edges.size());
  result.components = whole.count();
  result.rims = rim.count();
  return result;
}

double area(const ChordSheet& sheet) {
  double sum = 0;
  for (const Triangle& t : sheet.triangles) {
    const Vec3& a = sheet.vertices[t[0]].position;
    sum += 0.5 * norm(cross(sheet.vertices[t[1]].position - a, sheet.vertices[t[2]].position - a));
  }
  return sum;
}

// E = min(1 + z, 8.6 - z) in a cube: the square z = 3.8 between the outermost points.
TEST(ChordSheet, OppositeSlopesGiveASquare) {
  const BoxLattice box(9, 9, 9);
  const FrameField field =
      field_of_branches(box.lattice, {linear_branch(1, {0, 0, 1}), linear_branch(8.6, {0, 0, -1})});
  const ChordSheet sheet = chord_sheet(box.solid, box.lattice, field);
  EXPECT_EQ(sheet.shocks.size(), 81U);
  EXPECT_EQ(sheet.vertices.size(), 100U);
  EXPECT_EQ(sheet.triangles.size(), 162U);
  for (const SheetVertex& v : sheet.vertices) {
    EXPECT_NEAR(v.position.z, 3.8, 1e-12);
    EXPECT_NEAR(v.erosion, 4.8, 1e-12);
    EXPECT_EQ(v.strength, 1);
    EXPECT_NEAR(v.area, 1, 1e-12);
    EXPECT_EQ(v.normal_a, (Vec3{0, 0, 1}));
    EXPECT_EQ(v.normal_b, (Vec3{0, 0, -1}));
  }
  const Topology t = topology(sheet);
  EXPECT_EQ(t.euler, 1);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.rims, 1U);
  EXPECT_EQ(t.branching, 0U);
  EXPECT_NEAR(area(sheet), 64, 1e-9);
}

TEST(ChordSheet, ASlantingPlaneIsFlatAndWhole) {
  const BoxLattice box(12, 13, 14);
  const Vec3 a{1.3, 0.4, 2.1}, b{-0.9, -1.1, -0.3};
  const FrameField field = field_of_branches(box.lattice, {linear_branch(3, a), linear_branch(39, b)});
  const ChordSheet sheet = chord_sheet(box.solid, box.lattice, field);
  const Topology t = topology(sheet);
  EXPECT_EQ(t.euler, 1);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.rims, 1U);
  const Vec3 n = (1 / norm(a - b)) * (a - b);
  const double level = (39.0 - 3.0) / norm(a - b);
  for (const SheetVertex& v : sheet.vertices) {
    EXPECT_NEAR(dot(n, v.position), level, 0.05);
    EXPECT_NEAR(v.erosion, 3 + dot(a, v.position), 0.15);
    EXPECT_NEAR(norm(v.normal_a - (1 / norm(a)) * a) + norm(v.normal_b - (1 / norm(b)) * b), 0, 1e-12);
    EXPECT_NEAR(v.area, 0.5 * (norm(a) + norm(b)), 1e-12);
  }
}

// Three branches: three half planes that meet in the line x = 4.3, y = 4.4.
TEST(ChordSheet, ThreeBranchesMeetInALine) {
  const BoxLattice box(9, 9, 9);
  const auto branch = [](double x, double y) { return linear_branch(20 - (x * 4.3 + y * 4.4), {x, y, 0}); };
  const FrameField field = field_of_branches(box.lattice, {branch(2, 0), branch(-1, 1.7), branch(-1, -1.7)});
  const ChordSheet sheet = chord_sheet(box.solid, box.lattice, field);
  const Topology t = topology(sheet);
  EXPECT_EQ(t.euler, 1);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.branching, 9U);
  const double s = 1 / std::sqrt(9 + 1.7 * 1.7);
  for (const SheetVertex& v : sheet.vertices) {
    const double x = v.position.x - 4.3, y = v.position.y - 4.4;
    const double d0 = std::abs(y), d1 = s * std::abs(3 * x - 1.7 * y), d2 = s * std::abs(3 * x + 1.7 * y);
    EXPECT_LT(std::min({d0, d1, d2}), 0.25);
  }
}

// In a stretched frame the area of the section is still that of the mesh's coordinates.
TEST(ChordSheet, AreaIsInMeshUnitsWhateverTheFrame) {
  const Solid solid = make_solid(make_box(16, 8, 4));
  LatticeGrid grid;
  grid.axes = axes(1 / solid.scale(), 2, 1, 0.5);
  grid.dims = {8, 8, 8};
  grid.origin = -3.5 * (grid.axes[0] + grid.axes[1] + grid.axes[2]);
  const Lattice lattice = make_lattice(solid, grid);
  ASSERT_EQ(lattice.points, 512U);
  // Sections of area 3 across z: grad_u E = F^T (0, 0, +-3) = (0, 0, +-1.5).
  const FrameField field =
      field_of_branches(lattice, {linear_branch(1, {0, 0, 1.5}), linear_branch(11.8, {0, 0, -1.5})});
  const ChordSheet sheet = chord_sheet(solid, lattice, field);
  EXPECT_EQ(sheet.shocks.size(), 64U);
  for (const SheetVertex& v : sheet.vertices) EXPECT_NEAR(v.area, 3, 1e-12);
}

TEST(ChordSheet, ATorusGivesOneFlatAnnulus) {
  for (const double h : {0.2, 0.1}) {
    const ErodedSolid torus(make_torus(3, 1, 256), axes(h), "triangles");
    const ChordSheet sheet = chord_sheet(torus.solid, torus.lattice, torus.field);
    const Topology t = topology(sheet);
    EXPECT_EQ(t.components, 1U);
    EXPECT_EQ(t.euler, 0);
    EXPECT_EQ(t.rims, 2U);
    EXPECT_EQ(t.branching, 0U);
    for (const SheetVertex& v : sheet.vertices) {
      const Vec3 p = torus.place(v.position);
      EXPECT_LT(std::abs(p.z), 0.05 * h);
      EXPECT_GT(std::hypot(p.x, p.y), 1.9);
      EXPECT_LT(std::hypot(p.x, p.y), 4);
    }
  }
}

// Squares of gradients would leave the range of a double.
TEST(ChordSheet, SizesFarFromOneGiveTheSameSheetToTheLastBit) {
  const ErodedSolid plain(make_torus(3, 1, 256), axes(0.2), "triangles");
  const ChordSheet sheet = chord_sheet(plain.solid, plain.lattice, plain.field);
  ASSERT_FALSE(sheet.vertices.empty());
  for (const int power : {300, -300}) {
    const double scale = std::ldexp(1.0, power);
    const ErodedSolid torus(moved(make_torus(3, 1, 256), {}, scale), axes(0.2 * scale), "triangles");
    const ChordSheet other = chord_sheet(torus.solid, torus.lattice, torus.field);
    ASSERT_EQ(other.triangles, sheet.triangles) << power;
    for (std::size_t v = 0; v < sheet.vertices.size(); ++v) {
      EXPECT_EQ(other.vertices[v].position, scale * sheet.vertices[v].position);
      EXPECT_EQ(other.vertices[v].area, scale * scale * sheet.vertices[v].area);
      EXPECT_EQ(other.vertices[v].normal_a, sheet.vertices[v].normal_a);
    }
  }
}

// The level sets of a ball's E are spheres, those of an ellipsoid's homothetic ellipsoids: only the centre.
// Within two spacings, however fine the lattice is beside the facets of the direction set.
TEST(ChordSheet, BallAndEllipsoidShrinkToTheirCentres) {
  for (const double h : {0.11, 0.03}) {
    SCOPED_TRACE(h);
    const double s = std::cbrt(3.0);  // volume-preserving: 3:1:1 seen in its frame is a ball of radius s
    const ErodedSolid ball(make_sphere(1, 1280), axes(h), "sphere:5000");
    const ErodedSolid ellipsoid(make_ellipsoid(3, 1, 1, 1280), axes(s * h, 3 / s, 1 / s, 1 / s),
                                "sphere:5000");
    const std::vector<ChordShock> of_ball = chord_sheet(ball.solid, ball.lattice, ball.field).shocks;
    const std::vector<ChordShock> of_ellipsoid =
        chord_sheet(ellipsoid.solid, ellipsoid.lattice, ellipsoid.field).shocks;
    EXPECT_FALSE(of_ball.empty());
    EXPECT_FALSE(of_ellipsoid.empty());
    for (const ChordShock& shock : of_ball) EXPECT_LT(norm(ball.place(shock.position)), 2 * h);
    for (const ChordShock& shock : of_ellipsoid) {
      const Vec3 p = ellipsoid.place(shock.position);
      EXPECT_LT(norm({p.x * s / 3, p.y * s, p.z * s}), 2 * s * h);
    }
  }
}

// At this spacing: seen by all directions it is a ridge, and no shock (see measure_turns).
TEST(ChordSheet, ABoxGivesTheMiddleOfItsLargestFaces) {
  const ErodedSolid box(make_box(3, 2, 1), axes(0.1), "triangles+sphere:2000");
  const ChordSheet sheet = chord_sheet(box.solid, box.lattice, box.field);
  std::set<std::pair<std::uint32_t, std::uint32_t>> columns;
  for (const ChordShock& shock : sheet.shocks) {
    EXPECT_NEAR(box.place(shock.position).z, 0.5, 1e-9);
    columns.insert({shock.place[0], shock.place[1]});
  }
  for (std::uint32_t i = 6; i < 24; ++i) {
    for (std::uint32_t j = 5; j < 15; ++j) EXPECT_EQ(columns.count({i, j}), 1U) << i << " " << j;
  }
  EXPECT_EQ(topology(sheet).euler, 1);
  EXPECT_EQ(topology(sheet).components, 1U);
}

// The chords of a box by its own six directions meet at right angles, and what is one to rounding must not be
// for rounding to decide: neither turning the box nor a few last bits take walls away.
TEST(ChordSheet, RightAnglesAreNotForRoundingToDecide) {
  const Mesh box = make_box(3, 2, 1);
  const auto sheet_of = [](const Mesh& mesh) {
    const ErodedSolid solid(mesh, axes(0.07), "triangles");
    return chord_sheet(solid.solid, solid.lattice, solid.field);
  };
  const auto expect_whole = [](const ChordSheet& sheet) {
    // Twelve triangles, from the centre to the edges: half an edge times its distance.  The sheet ends a
    // spacing or so before the edges.
    const double whole = 2 * (std::hypot(1.5, 1) + 2 * std::hypot(1.5, 0.5) + 3 * std::hypot(1, 0.5));
    EXPECT_GT(area(sheet), 0.85 * whole);
    EXPECT_LT(area(sheet), 1.01 * whole);
    EXPECT_EQ(topology(sheet).components, 1U);
  };
  expect_whole(sheet_of(box));
  for (const double turn : {0.2, 0.5, 0.785398163397448, 1.1}) {
    SCOPED_TRACE(turn);
    Mesh turned = box;
    for (Vec3& p : turned.points) {
      p = {std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y, p.z};
      p = {p.x, std::cos(0.3) * p.y - std::sin(0.3) * p.z, std::sin(0.3) * p.y + std::cos(0.3) * p.z};
    }
    expect_whole(sheet_of(turned));
  }
  expect_whole(sheet_of(perturb(box, {1e-15, 1})));
}

// A quarter of a step apart, so that cells reach over the gap: a sheet each, and the one that it has alone.
TEST(ChordSheet, PartsOfASolidHaveASheetEach) {
  const auto sheet_in = [](const Mesh& mesh) {
    const Solid solid = make_solid(mesh);
    LatticeOptions options;
    options.spacing = 1;
    const Lattice lattice = make_lattice(solid, options);
    return chord_sheet(
        solid, lattice,
        field_of_branches(lattice, {linear_branch(1, {1, 0, 0}), linear_branch(8.6, {-1, 0, 0})}));
  };
  const Mesh box = make_box(9, 8, 3.75);
  const ChordSheet one = sheet_in(box), two = sheet_in(joined(box, moved(box, {0, 0, 4})));
  ASSERT_EQ(one.vertices.size(), 45U);
  ASSERT_EQ(two.vertices.size(), 90U);
  EXPECT_EQ(topology(two).components, 2U);
  EXPECT_EQ(two.pieces, (std::vector<double>{1, 1}));
  for (const SheetVertex& v : one.vertices) {
    for (const double z : {0.0, 4.0}) {
      EXPECT_TRUE(std::any_of(two.vertices.begin(), two.vertices.end(), [&](const SheetVertex& w) {
        return norm(w.position - v.position - Vec3{0, 0, z}) < 1e-12;
      }));
    }
  }
}

// The small one has 1/512 of the large one's volume.
TEST(ChordSheet, ASmallDiscBesideALargeOneKeepsItsSkeleton) {
  const Mesh large = make_cylinder(8, 4, 32), small = moved(make_cylinder(1, 0.5, 32), {16, 0, 0});
  const ErodedSolid alone(small, axes(0.25), "random:100:1");
  const ErodedSolid both(joined(large, small), axes(0.25), "random:100:1");
  const ChordSheet sheet = chord_sheet(alone.solid, alone.lattice, alone.field);
  std::vector<ChordShock> beside;
  for (const ChordShock& shock : chord_sheet(both.solid, both.lattice, both.field).shocks) {
    if (both.place(shock.position).x > 15) beside.push_back(shock);
  }
  ASSERT_GT(sheet.shocks.size(), 20U);
  ASSERT_EQ(beside.size(), sheet.shocks.size());
  for (std::size_t s = 0; s < beside.size(); ++s) {
    EXPECT_LT(norm(both.place(beside[s].position) - alone.place(sheet.shocks[s].position)), 1e-9);
    EXPECT_NEAR(beside[s].erosion, sheet.shocks[s].erosion, 1e-9);
  }
}

// Two teeth, [0, 1] and [2, 3] along x, that a bar joins at their upper ends, z in [3, 4].  The lattice has a
// column of points in the middle of each tooth, and a cell between the columns all corners of which lie
// inside.
struct Fork {
  Solid solid = make_solid(comb(2));
  Lattice lattice;

  Fork() {
    const double inner = 1 / solid.scale();
    LatticeGrid grid;
    grid.axes = axes(inner, 2, 0.25, 0.5);
    grid.dims = {2, 4, 8};
    grid.origin = inner * (Vec3{0.5, 0.125, 0.25} - solid.centre);
    lattice = make_lattice(solid, grid);
  }

  // In steps.
  std::vector<Vec3> vertices(std::vector<Branch> more = {}) const {
    const double h = lattice.spacing;
    more.push_back(linear_branch(1, {0, 0, 1 / h}));
    more.push_back(linear_branch(6, {0, 0, -1 / h}));
    std::vector<Vec3> result;
    for (const SheetVertex& v : chord_sheet(solid, lattice, field_of_branches(lattice, more)).vertices) {
      result.push_back((1 / h) * v.position);
    }
    return result;
  }
};

// The sheet z = 2.5 steps: on both sides of the gap it has vertices of its own, none in the gap.
TEST(ChordSheet, IsPartedByAGapThinnerThanASpacing) {
  const Fork fork;
  const SolidMembership membership(fork.solid.mesh);
  const std::vector<Vec3> vertices = fork.vertices();
  ASSERT_EQ(vertices.size(), 20U);
  for (const Vec3& v : vertices) {
    EXPECT_TRUE(v.x == 0 || v.x == 1) << v.x;
    EXPECT_NEAR(v.z, 2.5, 1e-12);
    EXPECT_TRUE(membership.contains(scaled_place(fork.lattice, v)));
  }
}

// Shocks in the second tooth only: drawn to the middle of their cell they would lie in the gap.
TEST(ChordSheet, AVertexInAGapIsDrawnToTheMeanOfTheShocks) {
  const Fork fork;
  const std::vector<Vec3> vertices = fork.vertices({linear_branch(0.5, {10 / fork.lattice.spacing, 0, 0})});
  std::size_t low = 0, between = 0;
  for (const Vec3& v : vertices) {
    if (v.z > 4) continue;
    ++low;
    EXPECT_NEAR(v.x, 1, 1e-12);
    between += std::abs(v.y - std::floor(v.y) - 0.5) < 1e-12 ? 1 : 0;
  }
  EXPECT_EQ(low, 10U);
  EXPECT_EQ(between, 6U);
}

TEST(ChordSheet, NoShocksGiveAnEmptySheet) {
  const BoxLattice box(3, 3, 3);
  const FrameField field = field_of_branches(box.lattice, {linear_branch(1, {0, 0, 1})});
  const ChordSheet sheet = chord_sheet(box.solid, box.lattice, field);
  EXPECT_TRUE(sheet.shocks.empty());
  EXPECT_TRUE(sheet.vertices.empty());
  EXPECT_TRUE(sheet.triangles.empty());
}

}  // namespace
}  // namespace affskel::core
