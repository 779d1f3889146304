#include "core/solid/shell_nesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/split_mix64.h"
#include "core/shapes/shapes.h"
#include "core/spatial/ray_crossing.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

/// Several closed surfaces in one mesh.
struct Shells {
  Mesh mesh;
  std::vector<std::uint32_t> of;  // per triangle
  std::uint32_t count = 0;

  void add(const Mesh& shell) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), shell.points.begin(), shell.points.end());
    for (const Triangle& t : shell.triangles)
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    of.resize(mesh.triangles.size(), count);
    ++count;
  }

  ShellNesting nest() const { return nest_shells(mesh, of, count); }
};

/// The definition, pair by pair and triangle by triangle.
class Oracle {
 public:
  explicit Oracle(const Shells& shells) : shells_(shells), extreme_(shells.count), triangles_(shells.count) {
    for (std::uint32_t t = 0; t < shells.of.size(); ++t) add(t, shells.of[t]);
  }

  ShellNesting nest() const {
    ShellNesting result{std::vector<std::uint32_t>(shells_.count, 0),
                        std::vector<std::uint32_t>(shells_.count, kNone)};
    std::vector<std::vector<std::uint32_t>> round(shells_.count);
    for (std::uint32_t a = 0; a < shells_.count; ++a) {
      for (std::uint32_t b = 0; b < shells_.count; ++b) {
        if (a != b && lies_in(a, b)) round[a].push_back(b);
      }
      result.depth[a] = static_cast<std::uint32_t>(round[a].size());
    }
    for (std::uint32_t a = 0; a < shells_.count; ++a) {
      for (const std::uint32_t b : round[a]) {
        std::uint32_t& parent = result.parent[a];
        if (parent == kNone || result.depth[b] > result.depth[parent]) parent = b;
      }
    }
    return result;
  }

 private:
  void add(std::uint32_t t, std::uint32_t shell) {
    const std::vector<Vec3>& points = shells_.mesh.points;
    std::array<std::uint32_t, 6>& extreme = extreme_[shell];
    if (triangles_[shell].empty()) extreme.fill(shells_.mesh.triangles[t][0]);
    triangles_[shell].push_back(t);
    for (const std::uint32_t v : shells_.mesh.triangles[t]) {
      for (int k = 0; k < 3; ++k) {
        std::uint32_t &least = extreme[static_cast<std::size_t>(2 * k)],
                      &most = extreme[static_cast<std::size_t>(2 * k + 1)];
        if (points[v][k] < points[least][k]) least = v;
        if (points[v][k] > points[most][k]) most = v;
      }
    }
  }

  bool lies_in(std::uint32_t a, std::uint32_t b) const {
    const std::vector<Vec3>& points = shells_.mesh.points;
    for (int k = 0; k < 3; ++k) {
      const auto low = static_cast<std::size_t>(2 * k), high = low + 1;
      if (!(points[extreme_[b][low]][k] < points[extreme_[a][low]][k])) return false;
      if (!(points[extreme_[a][high]][k] < points[extreme_[b][high]][k])) return false;
    }
    return std::all_of(extreme_[a].begin(), extreme_[a].end(),
                       [&](std::uint32_t v) { return inside(b, points[v]); });
  }

  bool inside(std::uint32_t shell, const Vec3& q) const {
    return std::count_if(triangles_[shell].begin(), triangles_[shell].end(),
                         [&](std::uint32_t t) {
                           const Triangle& corners = shells_.mesh.triangles[t];
                           return winding_round_line(shells_.mesh, corners, q, 2) != 0 &&
                                  distance_along(shells_.mesh, corners, q, 2) > 0;
                         }) %
               2 ==
           1;
  }

  const Shells& shells_;
  std::vector<std::array<std::uint32_t, 6>> extreme_;
  std::vector<std::vector<std::uint32_t>> triangles_;
};

void expect_as_defined(const Shells& shells, const std::string& what) {
  const ShellNesting found = shells.nest(), wanted = Oracle(shells).nest();
  EXPECT_EQ(found.depth, wanted.depth) << what;
  EXPECT_EQ(found.parent, wanted.parent) << what;
}

Mesh box_round(const Vec3& centre, double side) {
  return moved(make_box(side, side, side), centre - 0.5 * Vec3{side, side, side});
}

Shells nested_boxes(std::uint32_t count) {
  Shells shells;
  for (std::uint32_t i = 0; i < count; ++i) shells.add(box_round({0, 0, 0}, 1 + i));
  return shells;
}

Shells boxes_side_by_side(std::uint32_t per_side) {
  Shells shells;
  shells.add(box_round({0, 0, 0}, 10.0 * per_side));
  for (std::uint32_t i = 0; i < per_side * per_side * per_side; ++i) {
    const double x = i % per_side, y = i / per_side % per_side, z = i / per_side / per_side;
    shells.add(box_round({2 * x, 2 * y, 2 * z}, 1));
  }
  return shells;
}

// Boxes, balls and rings at random places of a cube, from tiny to as large as it.
Shells drawn(std::uint64_t seed, std::uint32_t count, bool on_grid) {
  SplitMix64 random{seed};
  Shells shells;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double size = std::pow(2.0, 3 * random.symmetric());
    Vec3 place = 6 * Vec3{random.symmetric(), random.symmetric(), random.symmetric()};
    if (on_grid) {
      // Faces, edges and vertices in common, rays through edges.
      place = {std::round(place.x), std::round(place.y), std::round(place.z)};
      shells.add(box_round(place, 2 * std::ceil(size)));
      continue;
    }
    switch (random.next() % 4) {
      case 0:
        shells.add(moved(make_sphere(1, 80), place, size));
        break;
      case 1:
        shells.add(moved(make_torus(1, 0.4, 64), place, size));
        break;
      case 2:
        shells.add(moved(make_box(4, 0.2, 0.2), place, size));
        break;
      default:
        shells.add(box_round(place, size));
    }
  }
  return shells;
}

TEST(NestShells, TakesOneSurfaceAlone) {
  Shells shells;
  shells.add(make_box(1, 1, 1));
  const ShellNesting nesting = shells.nest();
  EXPECT_EQ(nesting.depth, std::vector<std::uint32_t>{0});
  EXPECT_EQ(nesting.parent, std::vector<std::uint32_t>{kNone});
}

TEST(NestShells, CountsWhatIsRoundEachSurface) {
  const ShellNesting nesting = nested_boxes(50).nest();
  for (std::uint32_t i = 0; i < 50; ++i) {
    EXPECT_EQ(nesting.depth[i], 49 - i);
    EXPECT_EQ(nesting.parent[i], i == 49 ? kNone : i + 1);
  }
}

TEST(NestShells, AgreesWithTheDefinition) {
  expect_as_defined(nested_boxes(60), "nested");
  expect_as_defined(boxes_side_by_side(5), "side by side");
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    expect_as_defined(drawn(seed, 60, false), "seed " + std::to_string(seed));
    expect_as_defined(drawn(seed, 40, true), "on a grid, seed " + std::to_string(seed));
  }
}

// A needle makes one group of them all.
TEST(NestShells, AgreesWithTheDefinitionWhereOneSurfaceCrossesAll) {
  Shells shells = nested_boxes(40);
  shells.add(moved(make_box(0.1, 0.1, 100), {-0.05, -0.05, 0}));
  shells.add(box_round({0.3, 0.3, 0.3}, 0.1));
  expect_as_defined(shells, "pierced");
}

// The arm crosses the wall of the body; the cavity below it is the body's all the same.
TEST(NestShells, FindsTheBodyBehindWhatCrossesIt) {
  Shells shells;
  shells.add(box_round({0, 0, 0}, 10));
  shells.add(moved(make_box(1, 1, 20), {-0.5, -0.5, 2}));
  shells.add(box_round({0, 0, 0}, 1));
  const ShellNesting nesting = shells.nest();
  EXPECT_EQ(nesting.depth, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(nesting.parent[2], 0U);
  expect_as_defined(shells, "arm");
}

// Whatever the surfaces face, and where they are flat.
TEST(NestShells, DoesNotAskWhichWaySurfacesFace) {
  Shells shells;
  shells.add(reversed(box_round({0, 0, 0}, 10)));
  shells.add(moved(make_box(1, 1, 1e-300), {0, 0, 2}));
  shells.add(reversed(box_round({0, 0, 0}, 1)));
  shells.add(box_round({0, 0, 0}, 0.5));
  expect_as_defined(shells, "turned");
}

// Twice the surfaces cost about twice as much; that each met all others would be four times.
TEST(NestShells, CostGrowsWithTheSurfacesNotWithTheirPairs) {
  const auto tests = [](const Shells& shells) { return static_cast<double>(shells.nest().tests); };
  EXPECT_LT(tests(nested_boxes(4000)), 2.5 * tests(nested_boxes(2000)));
  EXPECT_LT(tests(nested_boxes(4000)), 4000 * 100);
  EXPECT_LT(tests(boxes_side_by_side(16)), 4096 * 100);
  EXPECT_LT(tests(boxes_side_by_side(16)), 2.5 * 8 * tests(boxes_side_by_side(8)));
}

TEST(NestShells, StopsWhereverItIsAsked) {
  const Shells shells = nested_boxes(3000);
  expect_stops_wherever_it_is_asked(5, [&](ExecutionContext* context) {
    nest_shells(shells.mesh, shells.of, shells.count, {1, context});
  });
}

}  // namespace
}  // namespace affskel::core
