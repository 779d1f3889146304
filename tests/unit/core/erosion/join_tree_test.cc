#include "core/erosion/join_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/error.h"
#include "core/erosion/directions.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Volume of all of V below height t, triangle by triangle in long double: with g_T(t) the integral of the
// share of T below t, V = sum -d.a_T g_T(t).
long double direct_volume(const Mesh& mesh, const Vec3& d, long double t) {
  long double sum = 0;
  const auto height = [&](const Vec3& p) {
    return static_cast<long double>(d.x) * p.x + static_cast<long double>(d.y) * p.y +
           static_cast<long double>(d.z) * p.z;
  };
  for (const Triangle& corner : mesh.triangles) {
    const Vec3 &p = mesh.points[corner[0]], &q = mesh.points[corner[1]], &r = mesh.points[corner[2]];
    std::array<long double, 3> h = {height(p), height(q), height(r)};
    std::sort(h.begin(), h.end());
    const auto [a, b, c] = h;
    const long double weight = -0.5L * dot(cross(q - p, r - p), d);
    if (t <= a) continue;
    if (t >= c) {
      sum += weight * (t - (a + b + c) / 3);
    } else if (t <= b) {
      sum += weight * (t - a) * (t - a) * (t - a) / (3 * (b - a) * (c - a));
    } else {
      sum += weight * (t - (a + b + c) / 3 + (c - t) * (c - t) * (c - t) / (3 * (c - b) * (c - a)));
    }
  }
  return sum;
}

// Sum of V over all components at height t.
double tree_volume(const JoinTree& tree, double t) {
  double sum = 0;
  for (const Arc& arc : tree.arcs) {
    if (t < tree.cubics[arc.first_cubic].height || t >= arc.top) continue;
    sum += tree.locate(arc, t).volume_at(t);
  }
  return sum;
}

struct Extent {
  double low = 1e300, high = -1e300;
};

Extent extent(const Mesh& mesh, const Vec3& d) {
  Extent e;
  for (const Vec3& p : mesh.points) {
    e.low = std::min(e.low, dot(d, p));
    e.high = std::max(e.high, dot(d, p));
  }
  return e;
}

void expect_direct_volumes(const Solid& solid, const DirectionSet& directions, double tolerance = 1e-11) {
  const TreeInput input(solid);
  JoinTreeBuilder builder(input);
  std::mt19937_64 random(1);
  const double unit = std::pow(solid.scale(), 3);
  for (const Vec3& d : directions) {
    if (d == Vec3{}) continue;
    const JoinTree& tree = builder.build(d);
    const Extent e = extent(solid.mesh, d);
    for (int i = 0; i < 20; ++i) {
      const double t = std::uniform_real_distribution<double>(e.low, e.high)(random);
      ASSERT_NEAR(tree_volume(tree, t), static_cast<double>(direct_volume(solid.mesh, d, t)),
                  tolerance * solid.volume / unit)
          << d.x << " " << d.y << " " << d.z << " at " << t;
    }
  }
}

TEST(JoinTree, VolumesEqualDirectSummation) {
  for (const Mesh& mesh : {make_torus(3, 1, 512), hollow_ball(), cup(24), comb(5), make_tetrahedron(1),
                           joined(make_sphere(1, 80), moved(make_torus(3, 0.5, 128), {0, 0, 0.2}))}) {
    const Solid solid = make_solid(mesh);
    expect_direct_volumes(solid, make_directions(solid, "triangles+random:100:1"));
  }
}

TEST(JoinTree, VolumesEqualDirectSummationOnLevelFaces) {
  for (const Mesh& mesh : {make_box(3, 2, 1, 8), make_cylinder(1, 2, 48), make_cone(1, 2, 48), cup(24)}) {
    const Solid solid = make_solid(mesh);
    expect_direct_volumes(solid, make_directions(solid, "triangles"));
  }
}

// Thousands of coplanar triangles, all level at once, and prisms: one normal per face.
TEST(JoinTree, VolumesEqualDirectSummationOnThousandsOfLevelTriangles) {
  const Solid box = make_solid(make_box(3, 2, 1, 40));
  DirectionSet faces;
  for (const Vec3& d : make_directions(box, "triangles")) {
    if (faces.empty() || norm(d - faces.back()) > 1e-9) faces.push_back(d);
  }
  ASSERT_GE(faces.size(), 6U);
  expect_direct_volumes(box, faces);
  for (std::uint32_t sides : {3U, 5U, 200U}) {
    const Solid prism = make_solid(make_cylinder(1, 2, sides));
    expect_direct_volumes(prism, make_directions(prism, "triangles"));
  }
}

// Faces tilted by less and less, from where they are triangles like others to where they count as level.
TEST(JoinTree, VolumesEqualDirectSummationOnNearlyLevelFaces) {
  const Solid solid = make_solid(make_box(3, 2, 1, 8));
  DirectionSet tilted;
  for (double tilt = 1e-3; tilt > 1e-16; tilt /= 3) {
    for (const Vec3& d : {Vec3{tilt, 0.3 * tilt, 1}, Vec3{-1, tilt, -0.7 * tilt}, Vec3{0, tilt, 1}}) {
      tilted.push_back((1 / norm(d)) * d);
    }
  }
  expect_direct_volumes(solid, tilted, 1e-10);
}

// Every n-th direction.
DirectionSet every(std::size_t n, const DirectionSet& all) {
  DirectionSet some;
  for (std::size_t i = 0; i < all.size(); i += n) some.push_back(all[i]);
  return some;
}

// Faces of many triangles that are level but for noise, each with a tilt of its own.
TEST(JoinTree, VolumesEqualDirectSummationOnNoisyFaces) {
  for (double noise : {1e-6, 1e-8, 1e-9, 1e-10, 3e-11, 2e-11, 1e-11, 3e-12, 1e-12, 1e-13}) {
    for (std::uint64_t seed : {1U, 2U, 3U}) {
      const Solid box = make_solid(shaken(make_box(1, 1, 1, 10), noise, seed), {true, false});
      expect_direct_volumes(box, every(9, make_directions(box, "triangles")), 2e-10);
    }
  }
}

TEST(JoinTree, VolumesEqualDirectSummationOnThinPlates) {
  for (double noise : {0.0, 1e-9, 1e-10, 3e-11, 1e-11, 2e-12}) {
    const Solid plain = make_solid(shaken(make_box(1, 1, 1e-3), noise, 4), {true, false});
    expect_direct_volumes(plain, make_directions(plain, "triangles+random:20:1"), 2e-8);
    // Vertices opposite each other: rays from inner minima meet corners of triangles.
    const Solid fine = make_solid(shaken(make_box(1, 1, 1e-4, 10), noise, 5), {true, false});
    expect_direct_volumes(fine, every(9, make_directions(fine, "triangles+random:180:1")), 2e-7);
  }
}

TEST(JoinTree, VolumesEqualDirectSummationOnNeedles) {
  Mesh mesh = make_box(1e-6, 1, 1, 6);
  const Solid thin = make_solid(mesh);
  // Heights are rounded to 2^-44 of the size, which is 6e-8 of this solid's thickness.
  expect_direct_volumes(thin, make_directions(thin, "random:50:2"), 1e-6);
  const Solid cone = make_solid(make_cone(1e-4, 1, 64));
  expect_direct_volumes(cone, make_directions(cone, "triangles+random:50:2"), 1e-9);
}

TEST(JoinTree, AreaIsTheDerivativeOfVolume) {
  const Solid solid = make_solid(make_torus(3, 1, 512));
  const TreeInput input(solid);
  JoinTreeBuilder builder(input);
  for (const Vec3& d : make_directions(solid, "random:20:1")) {
    const JoinTree& tree = builder.build(d);
    for (const Cubic& cubic : tree.cubics) {
      const double h = cubic.height + 1e-4, step = 1e-6;
      const double slope = (cubic.volume_at(h + step) - cubic.volume_at(h - step)) / (2 * step);
      EXPECT_NEAR(cubic.area_at(h), slope, 1e-7 * (1 + std::abs(cubic.sixth_bend)));
    }
  }
}

// What pruning relies on: the look-up is a lower bound everywhere, and a close one (small trees have several
// cells to a piece, large ones one).
TEST(JoinTree, LooksUpALowerBoundOfTheVolume) {
  for (std::uint32_t triangles : {128U, 5000U}) {
    const Solid solid = make_solid(make_torus(3, 1, triangles));
    const TreeInput input(solid);
    JoinTreeBuilder builder(input);
    const double tolerance = 2 * input.volume_tolerance();
    for (const Vec3& d : make_directions(solid, "random:20:2")) {
      const JoinTree& tree = builder.build(d);
      for (const Arc& arc : tree.arcs) {
        const double bottom = tree.cubics[arc.first_cubic].height, top = tree.cubics[arc.last_cubic].height;
        // In a cell V grows by at most its height times the largest section, here less than the bounding
        // box's.
        const double growth =
            arc.last_cubic > arc.first_cubic ? (top - bottom) / (arc.last_cubic - arc.first_cubic) * 1.1 : 0;
        for (int i = 0; i <= 200; ++i) {
          const double h = bottom + (top - bottom) * (i / 200.0);
          const double volume = tree.locate(arc, h).volume_at(h), bound = tree.volume_below(arc, h);
          ASSERT_LE(bound, volume + tolerance);
          ASSERT_GE(bound, volume - growth - tolerance);
        }
      }
    }
  }
}

// Folds turn parts of the surface inside out, where volumes fall: there it must hold all the way up.
TEST(JoinTree, LooksUpALowerBoundOfAllVolumesAboveWhereTheyFall) {
  const Mesh body = make_body({1000, 1800});
  const Solid solid = make_solid(perturb(body, {0.01 * box_diagonal(body), 3}));
  ASSERT_TRUE(solid.self_intersecting);
  const TreeInput input(solid);
  JoinTreeBuilder builder(input, {true});
  const double tolerance = 2 * input.volume_tolerance();
  const double volume_of_all = std::ldexp(solid.volume, -3 * solid.exponent);
  constexpr int kSamples = 100;
  std::size_t falling = 0, close = 0, all = 0;
  for (const Vec3& d : make_directions(solid, "random:20:2")) {
    const JoinTree& tree = builder.build(d);
    std::vector<double> least(tree.arcs.size());  // of what was sampled of an arc and above it
    for (std::size_t a = tree.arcs.size(); a-- > 0;) {
      const Arc& arc = tree.arcs[a];
      const bool root = arc.parent == kNone;
      const double top = root ? tree.cubics[arc.last_cubic].height : arc.top;
      least[a] = root ? 1e300 : least[arc.parent];
      for (int i = kSamples - 1; i >= 0; --i) {
        const double h = arc.bottom + (top - arc.bottom) * (i / double{kSamples});
        const double volume = tree.locate(arc, h).volume_at(h), bound = tree.volume_below(arc, h);
        falling += least[a] < volume - tolerance;
        least[a] = std::min(least[a], volume);
        ASSERT_LE(bound, least[a] + tolerance);
        close += bound > least[a] - 0.02 * volume_of_all;
        ++all;
      }
    }
  }
  EXPECT_GT(falling, 100U) << "none of them says anything about falling volumes";
  EXPECT_GT(close, all / 2);
}

TEST(JoinTree, CountsMinimaOfAComb) {
  const Solid solid = make_solid(comb(5));
  const TreeInput input(solid);
  JoinTreeBuilder builder(input);
  const auto leaves = [&](const Vec3& d) {
    const JoinTree& tree = builder.build((1 / norm(d)) * d);
    std::vector<bool> has_child(tree.arcs.size(), false);
    for (const Arc& arc : tree.arcs) {
      if (arc.parent != kNone) has_child[arc.parent] = true;
    }
    return std::count(has_child.begin(), has_child.end(), false);
  };
  EXPECT_EQ(leaves({0, 0, 1}), 5);  // five prongs from below
  EXPECT_EQ(leaves({0.01, 0.003, 1}), 5);
  EXPECT_EQ(leaves({0, 0, -1}), 1);  // the bar from above
  EXPECT_EQ(leaves({1, 0.01, -0.02}), 1);
  EXPECT_EQ(leaves({1, 0.01, 0.02}), 5);  // the lower left edge of each prong comes before its root
}

// Level h of a comb lying upside down: each prong is a component of its own until the bar.
TEST(JoinTree, KeepsComponentsApart) {
  const Solid solid = make_solid(comb(5));
  const TreeInput input(solid);
  JoinTreeBuilder builder(input);
  const JoinTree& tree = builder.build({0, 0, 1});
  const double unit = solid.scale();
  // Mesh height 2 above the tips.
  const double h = (2 - solid.centre.z) / unit;
  int components = 0;
  for (const Arc& arc : tree.arcs) {
    if (h < tree.cubics[arc.first_cubic].height || h >= arc.top) continue;
    ++components;
    EXPECT_NEAR(tree.locate(arc, h).volume_at(h) * unit * unit * unit, 2, 1e-12);
    EXPECT_NEAR(tree.locate(arc, h).area_at(h) * unit * unit, 1, 1e-12);
  }
  EXPECT_EQ(components, 5);
}

// The floor of the cup's inside is a minimum of the surface, but no new component.
TEST(JoinTree, InnerMinimaGiveNoComponents) {
  const Solid cup_solid = make_solid(cup(24));
  const TreeInput cup_input(cup_solid);
  JoinTreeBuilder cup_builder(cup_input);
  for (const Vec3& d : {Vec3{0, 0, 1}, Vec3{0.01, 0.02, 1}, Vec3{-0.3, 0.2, 1}}) {
    EXPECT_EQ(cup_builder.build((1 / norm(d)) * d).arcs.size(), 1U);
  }
  const Solid ball = make_solid(hollow_ball());
  const TreeInput ball_input(ball);
  JoinTreeBuilder ball_builder(ball_input);
  for (const Vec3& d : make_directions(ball, "random:200:9"))
    EXPECT_EQ(ball_builder.build(d).arcs.size(), 1U);
}

TEST(JoinTree, EverySolidIsARootOfItsVolume) {
  Mesh mesh = joined(make_torus(3, 0.5, 256), moved(hollow_ball(), {0, 0, 0.1}, 0.5));
  mesh = joined(mesh, moved(make_box(1, 1, 1), {9, 0, 0}));
  const Solid solid = make_solid(mesh);
  const TreeInput input(solid);
  JoinTreeBuilder builder(input);
  for (const Vec3& d : make_directions(solid, "triangles+random:100:1")) {
    const JoinTree& tree = builder.build(d);
    std::vector<double> volumes;
    for (const Arc& arc : tree.arcs) {
      if (arc.parent == kNone)
        volumes.push_back(tree.cubics[arc.last_cubic].volume * std::pow(solid.scale(), 3));
    }
    std::vector<double> expected = solid.solid_volume;
    std::sort(volumes.begin(), volumes.end());
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(volumes.size(), expected.size());
    for (std::size_t i = 0; i < volumes.size(); ++i)
      ASSERT_NEAR(volumes[i], expected[i], 1e-11 * solid.volume);
  }
}

std::uint32_t roots_of(const Mesh& mesh, const Vec3& d) {
  const Solid solid = make_solid(mesh);
  const TreeInput input(solid);
  JoinTreeBuilder builder(input, {true});
  return builder.build((1 / norm(d)) * d).roots;
}

TEST(JoinTree, PartsThatPassThroughEachOtherAreOne) {
  const Mesh ball = make_sphere(1, 320), box = make_box(1, 1, 1);
  for (const Vec3& d : {Vec3{1, 0, 0}, Vec3{-1, 0.2, 0.1}, Vec3{0.1, -0.3, 1}, Vec3{0, 0, -1}}) {
    EXPECT_EQ(roots_of(joined(ball, moved(ball, {1.1, 0.1, 0.2})), d), 1U);
    EXPECT_EQ(roots_of(joined(ball, moved(ball, {2.1, 0.1, 0.2})), d), 2U) << "apart";
    EXPECT_EQ(roots_of(joined(box, moved(box, {1, 0.3, 0.2})), d), 2U) << "touching";
  }
}

// The small ball's lower half lies in the large one: its lowest point is no birth.
TEST(JoinTree, MinimaInsideOtherPartsGiveNoComponents) {
  const Solid solid = make_solid(joined(make_sphere(1, 320), moved(make_sphere(1, 320), {0, 0, 0.9}, 0.5)));
  const TreeInput input(solid);
  JoinTreeBuilder builder(input, {true});
  EXPECT_EQ(builder.build({0, 0, 1}).arcs.size(), 1U);
}

TEST(JoinTree, LocateFindsTheCubicOfEveryHeight) {
  const Solid solid = make_solid(make_box(3, 2, 1, 8));
  const TreeInput input(solid);
  JoinTreeBuilder builder(input);
  for (const Vec3& d : make_directions(solid, "triangles+random:50:4")) {
    const JoinTree& tree = builder.build(d);
    for (const Arc& arc : tree.arcs) {
      const Cubic* cubics = tree.cubics.data();
      for (std::uint32_t i = arc.first_cubic; i <= arc.last_cubic; ++i) {
        ASSERT_EQ(&tree.locate(arc, cubics[i].height), &cubics[i]);
        if (i < arc.last_cubic) {
          ASSERT_EQ(&tree.locate(arc, std::nextafter(cubics[i + 1].height, -2)), &cubics[i]);
        }
      }
      ASSERT_EQ(&tree.locate(arc, -10), &cubics[arc.first_cubic]);
      ASSERT_EQ(&tree.locate(arc, 10), &cubics[arc.last_cubic]);
    }
  }
}

TEST(JoinTree, InvariantsCatchAMeshThatIsNotWhatItClaims) {
  Solid solid = make_solid(make_torus(3, 1, 256));
  solid.mesh.points[17].x += 0.1;  // volumes in `solid` are now wrong
  const TreeInput input(solid);
  JoinTreeBuilder builder(input);
  EXPECT_THROW(builder.build({0, 0, 1}), CoreError);
}

}  // namespace
}  // namespace affskel::core
