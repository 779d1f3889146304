#include "core/chord_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "chord_fields.h"
#include "core/chord_cells.h"
#include "core/error.h"
#include "core/shapes.h"

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

TEST(ChordCells, AnEdgeHasFourCellsOnceRound) {
  const BoxLattice box(3, 3, 3);
  ChordShock shock;
  shock.place = {0, 2, 1};
  shock.axis = 1;
  const std::vector<ChordShock> shocks{shock};
  const ChordCells cells = chord_cells(box.lattice, SolidParts(box.solid, box.lattice), shocks);
  ASSERT_EQ(cells.size(), 4U);
  EXPECT_EQ(cells.place[0], (CellPlace{-1, 2, 0}));
  EXPECT_EQ(cells.place[3], (CellPlace{0, 2, 1}));
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const CellPlace &a = cells.place[cells.ring[0][corner]],
                    &b = cells.place[cells.ring[0][(corner + 1) % 4]];
    EXPECT_EQ(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]), 1);
  }
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
  for (const ChordSheetVertex& v : sheet.vertices) {
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
  for (const ChordSheetVertex& v : sheet.vertices) {
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
  for (const ChordSheetVertex& v : sheet.vertices) {
    const double x = v.position.x - 4.3, y = v.position.y - 4.4;
    const double d0 = std::abs(y), d1 = s * std::abs(3 * x - 1.7 * y), d2 = s * std::abs(3 * x + 1.7 * y);
    EXPECT_LT(std::min({d0, d1, d2}), 0.25);
  }
}

// In a stretched frame the area of the section is still that of the mesh's coordinates.
TEST(ChordSheet, AreaIsInMeshUnitsWhateverTheFrame) {
  const Solid solid = make_solid(make_box(16, 8, 4));
  LatticeFrame frame;
  frame.axes = axes(1 / solid.scale(), 2, 1, 0.5);
  frame.dims = {8, 8, 8};
  frame.origin = -3.5 * (frame.axes[0] + frame.axes[1] + frame.axes[2]);
  const Lattice lattice = make_lattice(solid, frame);
  ASSERT_EQ(lattice.points, 512U);
  // Sections of area 3 across z: grad_u E = F^T (0, 0, +-3) = (0, 0, +-1.5).
  const FrameField field =
      field_of_branches(lattice, {linear_branch(1, {0, 0, 1.5}), linear_branch(11.8, {0, 0, -1.5})});
  const ChordSheet sheet = chord_sheet(solid, lattice, field);
  EXPECT_EQ(sheet.shocks.size(), 64U);
  for (const ChordSheetVertex& v : sheet.vertices) EXPECT_NEAR(v.area, 3, 1e-12);
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
    for (const ChordSheetVertex& v : sheet.vertices) {
      const Vec3 p = torus.place(v.position);
      EXPECT_LT(std::abs(p.z), 0.05 * h);
      EXPECT_GT(std::hypot(p.x, p.y), 1.9);
      EXPECT_LT(std::hypot(p.x, p.y), 4);
    }
  }
}

// The level sets of a ball's E are spheres, those of an ellipsoid's homothetic ellipsoids: only the centre.
TEST(ChordSheet, BallAndEllipsoidShrinkToTheirCentres) {
  const double s = std::cbrt(3.0);  // volume-preserving: 3:1:1 seen in its frame is a ball of radius s
  const ErodedSolid ball(make_sphere(1, 1280), axes(0.11), "sphere:5000");
  const ErodedSolid ellipsoid(make_ellipsoid(3, 1, 1, 1280), axes(0.15, 3 / s, 1 / s, 1 / s), "sphere:5000");
  const std::vector<ChordShock> of_ball = chord_sheet(ball.solid, ball.lattice, ball.field).shocks;
  const std::vector<ChordShock> of_ellipsoid =
      chord_sheet(ellipsoid.solid, ellipsoid.lattice, ellipsoid.field).shocks;
  EXPECT_FALSE(of_ball.empty());
  EXPECT_FALSE(of_ellipsoid.empty());
  for (const ChordShock& shock : of_ball) EXPECT_LT(norm(ball.place(shock.position)), 2 * 0.11);
  for (const ChordShock& shock : of_ellipsoid) {
    const Vec3 p = ellipsoid.place(shock.position);
    EXPECT_LT(norm({p.x * s / 3, p.y * s, p.z * s}), 2 * 0.15);
  }
}

TEST(ChordSheet, ABoxGivesTheMiddleOfItsLargestFaces) {
  const ErodedSolid box(make_box(3, 2, 1), axes(0.1), "triangles+sphere:2000");
  const ChordSheet sheet = chord_sheet(box.solid, box.lattice, box.field);
  std::set<std::pair<std::uint32_t, std::uint32_t>> columns;
  for (const ChordShock& shock : sheet.shocks) {
    EXPECT_NEAR(box.place(shock.position).z, 0.5, 1e-9);
    columns.insert({shock.place[0], shock.place[1]});
  }
  for (std::uint32_t i = 8; i < 22; ++i) {
    for (std::uint32_t j = 7; j < 13; ++j) EXPECT_EQ(columns.count({i, j}), 1U) << i << " " << j;
  }
  EXPECT_EQ(topology(sheet).euler, 1);
  EXPECT_EQ(topology(sheet).components, 1U);
}

TEST(ChordSheet, NoShocksGiveAnEmptySheet) {
  const BoxLattice box(3, 3, 3);
  const FrameField field = field_of_branches(box.lattice, {linear_branch(1, {0, 0, 1})});
  const ChordSheet sheet = chord_sheet(box.solid, box.lattice, field);
  EXPECT_TRUE(sheet.shocks.empty());
  EXPECT_TRUE(sheet.vertices.empty());
  EXPECT_TRUE(sheet.triangles.empty());
  ChordSheetOptions options;
  options.regularisation = 0;
  EXPECT_THROW(chord_sheet(box.solid, box.lattice, field, options), CoreError);
}

}  // namespace
}  // namespace affskel::core
