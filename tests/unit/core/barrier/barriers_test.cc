#include "core/barrier/barriers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "core/base/affine_map.h"
#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/mesh/map_mesh.h"
#include "core/shapes/shapes.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 unit_of(const Vec3& v) {
  return (1 / norm(v)) * v;
}

// A place in mesh coordinates, with normals of any length.
SheetPlace at(const Solid& solid, const Vec3& x, const Vec3& a, const Vec3& b) {
  return {(1 / solid.scale()) * (x - solid.centre), unit_of(a), unit_of(b)};
}

double barrier(const Solid& solid, const Vec3& x, const Vec3& a, const Vec3& b,
               std::uint32_t directions = 2562) {
  BarrierOptions options;
  options.directions = directions;
  const std::vector<SheetPlace> places = {at(solid, x, a, b)};
  return barriers(solid, places, options)[0];
}

// --- closed forms ------------------------------------------------------------------------------------
//
// In a convex solid f(d) + f(-d) = v0.  When a solid's symmetry carries one optimal normal to another, and
// the mirror images of all sublevel sets below v0 / 2 would have to meet their own antipodes for the two to
// join sooner, they join at v0 / 2: there barrier = v0 / (2 E) - 1.

// Four chords of 27/64 at the centroid, each a corner cut off; halves between two corners.
TEST(Barriers, OfATetrahedronsCentroid) {
  const Mesh mesh = make_tetrahedron(1);
  const Solid solid = make_solid(mesh);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 a = -mesh.points[i], b = -mesh.points[j];
      EXPECT_NEAR(barrier(solid, {}, a, b), 5.0 / 27, 4e-3);
      EXPECT_NEAR(barrier(solid, {}, a, b, 10242), 5.0 / 27, 1e-3);
    }
  }
}

// Three chords of 4/9.
TEST(Barriers, OfATriangularPrismsCentroid) {
  const Mesh mesh = make_cylinder(1, 1.2, 3);
  const Solid solid = make_solid(mesh);
  std::vector<Vec3> normals;
  for (const Vec3& p : mesh.points) {
    if (p.z == 0 && p.x * p.x + p.y * p.y > 0.5) normals.push_back({-p.x, -p.y, 0});
  }
  ASSERT_EQ(normals.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(barrier(solid, {0, 0, 0.6}, normals[i], normals[(i + 1) % 3]), 1.0 / 8, 4e-3);
}

// Three arms of length `arm` and width 1, `height` high, on the sides of an equilateral triangle about 0.
Mesh three_arms(double arm, double height) {
  std::vector<std::array<double, 2>> outline;
  const double in = std::sqrt(3.0) / 6;  // radius of the inscribed circle
  for (int k = 0; k < 3; ++k) {
    const double t = 2 * kPi / 3 * k, c = std::cos(t), s = std::sin(t);
    // From the hub's corner before side k, out along the arm, across it, and back.
    for (const auto& [u, v] : {std::array{in, -0.5}, {in + arm, -0.5}, {in + arm, 0.5}})
      outline.push_back({c * u - s * v, s * u + c * v});
  }
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, height}) {
    for (const auto& [x, y] : outline) mesh.points.push_back({x, y, z});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
  }
  // The hub, and two triangles for each arm, seen from below and from above.
  std::vector<Triangle> lid = {{0, 3, 6}};
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t a = 3 * k, b = a + 1, c = a + 2, d = (a + 3) % n;
    lid.push_back({a, b, c});
    lid.push_back({a, c, d});
  }
  for (const Triangle& t : lid) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  return mesh;
}

// A strict shock: to turn from one arm to another, the plane must take in half of all.  Below the plane
// through the centre lie one arm, 5/9 of the hub and a corner of either other arm, of area 1 / (6 sqrt 3).
TEST(Barriers, BetweenThreeArmsIsLarge) {
  const double arm = 4, height = 0.7;
  const Solid solid = make_solid(three_arms(arm, height));
  const double hub = std::sqrt(3.0) / 4, section = hub + 3 * arm;
  ASSERT_NEAR(solid.volume, section * height, 1e-9);
  const double least = arm + 5.0 / 9 * hub + 2 / (6 * std::sqrt(3.0));
  const Vec3 a{-1, 0, 0}, b{0.5, -std::sqrt(3.0) / 2, 0};
  const double wanted = section / (2 * least) - 1;
  EXPECT_GT(wanted, 0.4);
  EXPECT_NEAR(barrier(solid, {0, 0, height / 2}, a, b), wanted, 0.02);
  EXPECT_NEAR(barrier(solid, {0, 0, height / 2}, a, b, 10242), wanted, 0.01);
}

// Away from its centre an ellipsoid's f has one minimum, as a ball's; at the centre f is v0 / 2 everywhere.
TEST(Barriers, OfAnEllipsoidAreNone) {
  const Solid solid = make_solid(make_ellipsoid(3, 2, 1, 1280));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  for (int n = 0; n < 10; ++n) {
    const Vec3 x{3 * part(random), 2 * part(random), part(random)};
    EXPECT_LT(barrier(solid, x, {part(random), part(random), 1}, {part(random), part(random), -1}), 1e-4);
  }
  EXPECT_LT(barrier(solid, {}, {0.1, 0.2, 1}, {0, 0, -1}), 1e-5);
}

// The normals turn fast across the plane of the long axis, but jump nowhere beside the cylinder's own axis.
// What is left is the sphere's grain, along a valley that runs aslant to its neighbours.
TEST(Barriers, OfAnEllipticCylinderAreNone) {
  Mesh mesh = make_cylinder(1, 6, 64);
  for (Vec3& p : mesh.points) p.y *= 0.5;
  const Solid solid = make_solid(mesh);
  for (const double x : {0.15, 0.3, 0.5}) {
    for (const double z : {2.0, 3.0}) {
      EXPECT_LT(barrier(solid, {x, 0, z}, {-0.5, 1, 0}, {-0.5, -1, 0}), 6e-3) << x << " " << z;
      EXPECT_LT(barrier(solid, {x, 0, z}, {-0.5, 1, 0}, {-0.5, -1, 0}, 10242), 2e-3) << x << " " << z;
    }
  }
}

// --- box and tetrahedron, by formulas, another grid and another way to the pass ------------------------

// Volume of the part of the box [0, a] x [0, b] x [0, c] where n.y <= t; no component of n is 0.
double volume_below(const Vec3& box, const Vec3& n, double t) {
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double h = t, sign = 1;
    for (int k = 0; k < 3; ++k) {
      if ((corner >> k & 1) == 0) continue;
      h -= n[k] * box[k];
      sign = -sign;
    }
    if (h > 0) sum += sign * h * h * h;
  }
  return sum / (6 * n.x * n.y * n.z);
}

// The same as a share of the tetrahedron with the given corners, no two at the same height.
double share_below(const std::vector<Vec3>& corners, const Vec3& n, double t) {
  double sum = 0;
  for (const Vec3& p : corners) {
    const double h = t - dot(n, p);
    if (h <= 0) continue;
    double product = 1;
    for (const Vec3& q : corners) product *= &q == &p ? 1 : dot(n, q - p);
    sum += h * h * h / product;
  }
  return sum;
}

// Degrees of longitude and latitude, no node on an axis.
class Degrees {
 public:
  static constexpr int kRows = 180, kColumns = 360;
  static std::uint32_t node(int row, int column) {
    return static_cast<std::uint32_t>(row * kColumns + (column + kColumns) % kColumns);
  }
  static Vec3 direction(std::uint32_t node) {
    const double polar = (node / kColumns + 0.53) * kPi / kRows, round = (node % kColumns + 0.51) * kPi / 180;
    return {std::sin(polar) * std::cos(round), std::sin(polar) * std::sin(round), std::cos(polar)};
  }
  static std::vector<std::uint32_t> near(std::uint32_t at) {
    const int row = static_cast<int>(at) / kColumns, column = static_cast<int>(at) % kColumns;
    std::vector<std::uint32_t> list;
    for (int r = row - 1; r <= row + 1; ++r) {
      for (int c = column - 1; c <= column + 1; ++c) {
        // Over a pole to the other side.
        if (r < 0 || r >= kRows)
          list.push_back(node(row, c + kColumns / 2));
        else
          list.push_back(node(r, c));
      }
    }
    return list;
  }
};

// The barrier of chord(d) between two normals.
template <class Chord>
double barrier_of(const Chord& chord, const Vec3& a, const Vec3& b) {
  constexpr std::uint32_t kNodes = Degrees::kRows * Degrees::kColumns;
  std::vector<double> f(kNodes);
  for (std::uint32_t v = 0; v < kNodes; ++v) f[v] = chord(Degrees::direction(v));
  const auto minimum = [&](const Vec3& normal) {
    std::uint32_t v = 0;
    for (std::uint32_t w = 1; w < kNodes; ++w) {
      if (dot(Degrees::direction(w), normal) > dot(Degrees::direction(v), normal)) v = w;
    }
    for (;;) {
      const auto near = Degrees::near(v);
      const std::uint32_t least = *std::ranges::min_element(near, {}, [&](auto w) { return f[w]; });
      if (f[least] >= f[v]) return v;
      v = least;
    }
  };
  const std::uint32_t from = minimum(a), to = minimum(b);
  if (from == to) return 0;
  std::vector<std::uint32_t> order(kNodes);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](auto v) { return f[v]; });
  DisjointSets sets(kNodes);
  std::vector<bool> there(kNodes, false);
  for (const std::uint32_t v : order) {
    there[v] = true;
    for (const std::uint32_t w : Degrees::near(v)) {
      if (there[w]) sets.unite(v, w);
    }
    if (sets.find(from) == sets.find(to)) return f[v] / std::max(f[from], f[to]) - 1;
  }
  return -1;
}

struct JumpPlace {
  Vec3 place, a, b;
};

// Boxes have no jump: along the middle rectangle f is level from one side's normal to the other's.
TEST(Barriers, OfABoxAreThoseOfItsFormula) {
  const std::vector<JumpPlace> places = {
      // The middle rectangle: towards its middle, its short side, its corner.
      {{2, 1.5, 0.5}, {0.2, 0, 1}, {0.2, 0, -1}},
      {{1.2, 1.2, 0.5}, {0.3, 0.2, 1}, {0.3, 0.2, -1}},
      {{0.5, 1.5, 0.5}, {1, 0, 0.8}, {1, 0, -0.8}},
      {{0.6, 0.6, 0.5}, {1, 1, 1}, {1, 1, -1}},
      // Equally far from two long faces or from two sides.
      {{3, 0.3, 0.3}, {0, 0.3, 1}, {0, 1, 0.3}},
      {{0.3, 1.5, 0.3}, {1, 0.5, 1}, {1, -0.5, 1}},
  };
  const Vec3 box{6, 3, 1};
  const Solid solid = make_solid(make_box(box.x, box.y, box.z));
  for (const auto& [x, a, b] : places) {
    const auto chord = [&](const Vec3& d) { return volume_below(box, d, dot(d, x)); };
    const double wanted = barrier_of(chord, unit_of(a), unit_of(b));
    EXPECT_LT(wanted, 1e-3) << x.x << " " << x.y << " " << x.z;
    EXPECT_NEAR(barrier(solid, x, a, b), wanted, 0.015) << x.x << " " << x.y << " " << x.z;
    EXPECT_NEAR(barrier(solid, x, a, b, 10242), wanted, 4e-3) << x.x << " " << x.y << " " << x.z;
  }
}

// Between the corners of a tetrahedron the normals jump.
TEST(Barriers, OfATetrahedronAreThoseOfItsFormula) {
  const Mesh mesh = make_tetrahedron(1);
  const Solid solid = make_solid(mesh);
  const std::vector<Vec3>& corner = mesh.points;
  double least = 1, greatest = 0;
  // Places with the barycentric coordinates s, s, t, u: as far from the first corner as from the second.
  for (const auto& [t, u] : {std::array{0.25, 0.25}, {0.1, 0.3}, {0.35, 0.25}, {0.4, 0.1}, {0.15, 0.2}}) {
    const double s = (1 - t - u) / 2;
    const Vec3 x = s * corner[0] + s * corner[1] + t * corner[2] + u * corner[3];
    const auto chord = [&](const Vec3& d) { return share_below(corner, d, dot(d, x)); };
    const Vec3 a = x - corner[0], b = x - corner[1];
    const double wanted = barrier_of(chord, unit_of(a), unit_of(b));
    EXPECT_NEAR(barrier(solid, x, a, b, 10242), wanted, 5e-3) << t << " " << u;
    least = std::min(least, wanted);
    greatest = std::max(greatest, wanted);
  }
  EXPECT_LT(least, 0.05);
  EXPECT_GT(greatest, 0.15);
}

// --- what they depend on ------------------------------------------------------------------------------

// Places round the middle of three arms that nothing is symmetric about, with the normals of two arms.
std::vector<JumpPlace> star_places(int count) {
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> part(-1, 1);
  std::vector<JumpPlace> places;
  for (int n = 0; n < count; ++n) {
    const double t = 2 * kPi / 3 * n, u = t + 2 * kPi / 3;
    places.push_back({{0.5 * part(random), 0.5 * part(random), 0.35 + 0.2 * part(random)},
                      {-std::cos(t), -std::sin(t), 0.3 * part(random)},
                      {-std::cos(u), -std::sin(u), 0.3 * part(random)}});
  }
  return places;
}

// Its corners moved a little, so that no two chords are equal by symmetry.
const Mesh kStar = [] {
  Mesh mesh = three_arms(4, 0.7);
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> part(-0.05, 0.05);
  for (Vec3& p : mesh.points) p = p + Vec3{part(random), part(random), part(random)};
  return mesh;
}();

std::vector<double> star_barriers(const BarrierOptions& options, int count = 60) {
  const Solid solid = make_solid(kStar);
  std::vector<SheetPlace> places;
  for (const auto& [x, a, b] : star_places(count)) places.push_back(at(solid, x, a, b));
  return barriers(solid, places, options);
}

TEST(Barriers, GoAlongWithAffineMaps) {
  const AffineMap map = then(then(shear(1, 2, 0.8), scaling(2, 0.7, 1 / 1.4)), translation({5, -3, 1}));
  const NormalMap normals(map);
  const Solid image = make_solid(map_mesh(map, kStar));
  std::vector<SheetPlace> places;
  for (const auto& [x, a, b] : star_places(60))
    places.push_back(at(image, map(x), normals(unit_of(a)), normals(unit_of(b))));
  BarrierOptions options, mapped;
  options.directions = mapped.directions = 642;
  const auto& rows = map.rows;
  mapped.frame = {Vec3{rows[0].x, rows[1].x, rows[2].x}, Vec3{rows[0].y, rows[1].y, rows[2].y},
                  Vec3{rows[0].z, rows[1].z, rows[2].z}};
  const std::vector<double> before = star_barriers(options), after = barriers(image, places, mapped);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-5) << i;
  EXPECT_GT(*std::ranges::max_element(before), 0.1);
}

TEST(Barriers, AreTheSameOnAnyThreadsAndInAnyMemory) {
  BarrierOptions one, many;
  one.directions = many.directions = 162;
  many.threads = 3;
  many.memory = 4 * 162 * 7;  // seven places at a time
  const std::vector<double> wanted = star_barriers(one);
  EXPECT_GT(std::ranges::count_if(wanted, [](double b) { return b > 0.1; }), 10);
  EXPECT_EQ(wanted, star_barriers(many));
  many.memory = 1;  // one by one
  EXPECT_EQ(wanted, star_barriers(many));
}

// Each of two solids has the chords that it would have alone.
TEST(Barriers, OfTwoSolidsAreThoseOfEach) {
  const Mesh mesh = make_tetrahedron(1);
  const Solid solid = make_solid(joined(mesh, moved(make_box(1, 1, 1), {2, 0, 0})));
  EXPECT_NEAR(barrier(solid, {}, -mesh.points[0], -mesh.points[1]), 5.0 / 27, 4e-3);
}

TEST(Barriers, AreNoneOutsideAndWithoutNormals) {
  const Mesh mesh = make_tetrahedron(1);
  const Solid solid = make_solid(mesh);
  const std::vector<SheetPlace> places = {{{}, -unit_of(mesh.points[0]), {}},
                                          at(solid, {2, 0, 0}, mesh.points[0], mesh.points[1])};
  EXPECT_EQ(barriers(solid, places), (std::vector<double>{0, 0}));
  EXPECT_TRUE(barriers(solid, {}).empty());
}

TEST(Barriers, RefuseOptionsOutOfRange) {
  BarrierOptions few, many, nothing, flat;
  few.directions = 11;
  many.directions = (1 << 20) + 1;
  nothing.memory = 0;
  flat.frame[2] = {};
  for (const BarrierOptions& options : {few, many, nothing, flat}) {
    try {
      star_barriers(options, 1);
      ADD_FAILURE() << "not refused";
    } catch (const CoreError& error) {
      EXPECT_EQ(error.code(), CoreError::Code::kBadInput) << error.what();
    }
  }
}

TEST(Barriers, StopWhenTheirContextAsks) {
  expect_stops_wherever_it_is_asked(42, [](ExecutionContext* context) {
    BarrierOptions options;
    options.directions = 42;
    options.context = context;
    star_barriers(options, 3);
  });
}

// Stops the thread that asks first.
class StopsOneThread : public ExecutionContext {
 public:
  bool stop_requested() override { return asked_++ == 0; }
  std::uint64_t asked() const { return asked_; }

 private:
  std::atomic<std::uint64_t> asked_{0};
};

TEST(Barriers, EndOnAllThreadsWhenOneFails) {
  StopsOneThread context;
  BarrierOptions options;
  options.directions = 40962;
  options.threads = 2;
  options.context = &context;
  EXPECT_THROW(star_barriers(options, 3), CoreError);
  EXPECT_LT(context.asked(), 40962U);
}

}  // namespace
}  // namespace affskel::core
