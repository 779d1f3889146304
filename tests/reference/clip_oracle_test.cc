#include "clip_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/lattice/all_places.h"
#include "core/lattice/lattice.h"
#include "core/mesh/edges.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/test_solids.h"
#include "fuzz/block_solid.h"
#include "hard_solids.h"

namespace affskel::reference {
namespace {

using core::Mesh;
using core::Vec3;

// Below this distance from a vertex, relative to the size of the solid, a plane counts as passing through it.
// The core rounds heights to 2^-44 of the size.
constexpr double kTie = 0x1p-40;
constexpr double kTolerance = 1e-9;  // of v0

struct Plan {
  std::string name;
  Mesh mesh;
  double spacing = 0;       // of the lattice, mesh units
  std::size_t normals = 0;  // directions drawn from the triangles' normals
  std::size_t random = 0;   // uniform directions
  std::vector<Vec3> hard;   // directions along symmetries, of any length
  std::size_t points = 0;   // per direction
};

// Compares the core with the oracle, pair by pair.
class Comparison {
 public:
  Comparison(const std::string& name, const Mesh& mesh)
      : name_(name), mesh_(mesh), solid_(core::make_solid(mesh)), oracle_(mesh) {}

  ~Comparison() {
    std::cout << name_ << ": " << pairs_ << " pairs, largest deviation " << largest_
              << " v0, planes through vertices " << ties_ << ", of these at a jump or an edge " << jumps_
              << '\n';
  }

  const core::Solid& solid() const { return solid_; }
  std::size_t pairs() const { return pairs_; }
  std::size_t ties() const { return ties_; }

  // E of the lattice's points, mesh units cubed, for direction d alone.
  std::vector<double> core_chords(const core::Lattice& lattice, const Vec3& d) const {
    const core::DirectionSet set = {d};
    core::Erosion erosion(solid_, lattice, set, {});
    core::ExecutionContext context;
    const std::vector<std::uint32_t> list = {0};
    erosion.run(list, context);
    std::vector<double> chords;
    for (std::uint32_t p = 0; p < lattice.points; ++p)
      chords.push_back(erosion.field().value(p).erosion * std::pow(solid_.scale(), 3));
    return chords;
  }

  void pair(const Vec3& x, const Vec3& d, double core_chord) {
    ++pairs_;
    double off = deviation(x, d, core_chord);
    if (through_vertex(x, d)) {
      ++ties_;
      if (off > kTolerance) {
        // Pieces may touch in the plane itself, joined for the core and apart for the oracle: then the
        // value must be the one just above or just below.
        ++jumps_;
        const Vec3 shift = (4 * kTie * solid_.scale()) * d;
        off = std::min(deviation(x + shift, d, core_chord), deviation(x - shift, d, core_chord));
      }
    }
    largest_ = std::max(largest_, off);
    EXPECT_LE(off, kTolerance) << name_ << ": x = (" << x.x << ", " << x.y << ", " << x.z << "), d = (" << d.x
                               << ", " << d.y << ", " << d.z << "), core " << core_chord;
  }

 private:
  // Relative to v0; infinite when the oracle cannot tell.
  double deviation(const Vec3& x, const Vec3& d, double core_chord) {
    try {
      return std::abs(core_chord - oracle_.chord(x, d)) / solid_.volume;
    } catch (const CutRefused&) {
      return std::numeric_limits<double>::infinity();
    }
  }

  bool through_vertex(const Vec3& x, const Vec3& d) const {
    return std::any_of(mesh_.points.begin(), mesh_.points.end(),
                       [&](const Vec3& v) { return std::abs(dot(d, v - x)) < kTie * solid_.scale(); });
  }

  const std::string name_;
  const Mesh mesh_;
  const core::Solid solid_;
  ClipOracle oracle_;
  std::size_t pairs_ = 0;
  std::size_t ties_ = 0;   // pairs whose plane passes through a vertex
  std::size_t jumps_ = 0;  // of these, those compared with the planes just beside
  double largest_ = 0;     // deviation, of v0
};

core::DirectionSet directions(const Plan& plan, const core::Solid& solid, std::mt19937_64& random) {
  const core::DirectionSet normals = core::make_directions(solid, "triangles");
  core::DirectionSet set = core::make_directions(solid, "random:" + std::to_string(plan.random) + ":7");
  for (std::size_t i = 0; i < plan.normals; ++i) set.push_back(normals[random() % normals.size()]);
  for (const Vec3& d : plan.hard) set.push_back((1 / norm(d)) * d);
  return set;
}

// Sample points of a lattice, as in a real job.
void compare(const Plan& plan) {
  Comparison comparison(plan.name, plan.mesh);
  core::LatticeOptions options;
  options.spacing = plan.spacing;
  const core::Lattice lattice = core::make_lattice(comparison.solid(), options);
  const std::vector<Vec3> place = core::all_places(comparison.solid(), lattice);
  ASSERT_EQ(place.size(), lattice.points);
  std::mt19937_64 random(20031);
  for (const Vec3& d : directions(plan, comparison.solid(), random)) {
    const std::vector<double> chord = comparison.core_chords(lattice, d);
    for (std::size_t i = 0; i < plan.points; ++i) {
      const std::size_t p = random() % place.size();
      comparison.pair(place[p], d, chord[p]);
    }
  }
  EXPECT_EQ(comparison.pairs(), (plan.normals + plan.random + plan.hard.size()) * plan.points);
}

// A lattice of 3 x 3 x 3 points close round x; its middle is x.
core::LatticeGrid close_frame(const core::Solid& solid, const Vec3& x) {
  constexpr double kStep = 1e-6;
  core::LatticeGrid grid;
  grid.axes = {Vec3{kStep, 0, 0}, {0, kStep, 0}, {0, 0, kStep}};
  grid.origin = (1 / solid.scale()) * (x - solid.centre) - Vec3{kStep, kStep, kStep};
  grid.dims = {3, 3, 3};
  return grid;
}

// x's chord, or nothing when x is not inside, or too close to the surface to tell.
std::optional<double> core_chord(const Comparison& comparison, const Vec3& x, const Vec3& d) {
  try {
    const core::Lattice lattice = core::make_lattice(comparison.solid(), close_frame(comparison.solid(), x));
    if (lattice.points != 27) return {};
    core::LatticeGrid middle = lattice.grid;
    middle.origin = middle.origin + middle.axes[0] + middle.axes[1] + middle.axes[2];
    middle.dims = {1, 1, 1};
    return comparison.core_chords(core::make_lattice(comparison.solid(), middle), d)[0];
  } catch (const core::CoreError& error) {
    if (error.code() == core::CoreError::Code::kBadInput) return {};  // no point inside
    throw;
  }
}

// Points at the height of a vertex, found by seeded trial: planes through vertices, edges and faces.
void compare_at_vertex_heights(const Plan& plan) {
  Comparison comparison(plan.name, plan.mesh);
  const core::Solid& solid = comparison.solid();
  std::mt19937_64 random(1997);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (const Vec3& d : directions(plan, solid, random)) {
    std::size_t trials = 0;
    for (std::size_t i = 0; i < plan.points;) {
      ASSERT_LT(++trials, 100000U) << plan.name << ": no vertex is at the height of an inner point";
      const Vec3 y = {uniform(solid.bbox_min.x, solid.bbox_max.x),
                      uniform(solid.bbox_min.y, solid.bbox_max.y),
                      uniform(solid.bbox_min.z, solid.bbox_max.z)};
      const Vec3 x = y + dot(d, plan.mesh.points[random() % plan.mesh.points.size()] - y) * d;
      const std::optional<double> chord = core_chord(comparison, x, d);
      if (!chord) continue;
      comparison.pair(x, d, *chord);
      ++i;
    }
  }
  EXPECT_EQ(comparison.pairs(), (plan.normals + plan.random + plan.hard.size()) * plan.points);
  EXPECT_EQ(comparison.ties(), comparison.pairs());
}

const std::vector<Vec3> kAxes = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

std::vector<Vec3> axes_and_diagonals() {
  std::vector<Vec3> all = kAxes;
  for (const Vec3& d : {Vec3{1, 1, 0}, Vec3{0, -1, 1}, Vec3{1, 0, 1}, Vec3{1, 1, 1}, Vec3{-1, 1, -1}})
    all.push_back(d);
  return all;
}

TEST(ClipOracle, Torus) {
  compare({"torus", core::make_torus(3, 1, 256), 0.3, 60, 60, axes_and_diagonals(), 10});
}

TEST(ClipOracle, Cup) {
  compare({"cup", core::cup(24), 0.2, 60, 60, axes_and_diagonals(), 10});
}

TEST(ClipOracle, HollowBall) {
  compare({"hollow ball", core::hollow_ball(), 0.35, 60, 60, axes_and_diagonals(), 8});
}

TEST(ClipOracle, NestedShells) {
  compare({"nested shells", nested_shells(), 0.3, 60, 60, axes_and_diagonals(), 8});
}

TEST(ClipOracle, Helix) {
  compare({"helix", make_helix(3, 0.7, 2, 3, 16, 8), 0.3, 60, 60, axes_and_diagonals(), 8});
}

TEST(ClipOracle, Comb) {
  compare({"comb", core::comb(5), 0.21, 24, 60, axes_and_diagonals(), 10});
}

TEST(ClipOracle, LinkedTori) {
  compare({"linked tori", linked_tori(256), 0.3, 60, 60, axes_and_diagonals(), 8});
}

TEST(ClipOracle, Body) {
  compare({"body", core::make_body(), 40, 60, 60, axes_and_diagonals(), 6});
}

TEST(ClipOracle, PlanesThroughVerticesOfATorus) {
  compare_at_vertex_heights({"torus, ties", core::make_torus(3, 1, 128), 0, 20, 5, axes_and_diagonals(), 6});
}

TEST(ClipOracle, PlanesThroughVerticesOfACup) {
  compare_at_vertex_heights({"cup, ties", core::cup(24), 0, 20, 5, axes_and_diagonals(), 6});
}

// All its vertices have y = 0 or 1: no plane across y passes through vertices and the inside.
TEST(ClipOracle, PlanesThroughVerticesOfAComb) {
  compare_at_vertex_heights(
      {"comb, ties", core::comb(5), 0, 0, 5, {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {1, 0, 1}}, 20});
}

TEST(ClipOracle, PlanesThroughVerticesOfABox) {
  compare_at_vertex_heights({"box, ties", core::make_box(3, 2, 1, 4), 0, 10, 5, axes_and_diagonals(), 6});
}

TEST(ClipOracle, PlanesThroughVerticesOfNestedShells) {
  compare_at_vertex_heights({"nested shells, ties", nested_shells(), 0, 20, 5, axes_and_diagonals(), 6});
}

TEST(ClipOracle, PlanesThroughVerticesOfLinkedTori) {
  compare_at_vertex_heights({"linked tori, ties", linked_tori(128), 0, 20, 5, axes_and_diagonals(), 6});
}

// The oracle itself, against closed forms.
TEST(ClipOracle, KnowsBoxesAndCavities) {
  ClipOracle box(core::make_box(1, 2, 3));
  EXPECT_NEAR(box.chord({0.5, 0.5, 0.75}, {0, 0, 2}), 1.5, 1e-14);
  EXPECT_NEAR(box.chord({0.25, 0.25, 0.25}, {1, 1, 1}), 0.75 * 0.75 * 0.75 / 6, 1e-14);

  Mesh hollow =
      joined(core::make_box(4, 4, 4), core::reversed(core::moved(core::make_box(2, 2, 2), {1, 1, 1})));
  hollow = joined(hollow, core::moved(core::make_box(1, 1, 1), {1.5, 1.5, 1.5}));
  ClipOracle shell(hollow);
  EXPECT_NEAR(shell.chord({0.5, 0.5, 3.5}, {0, 0, 1}), 56 - 8, 1e-13);  // past the cavity: 4 4 3.5 - 8
  EXPECT_NEAR(shell.chord({0.5, 0.5, 2}, {0, 0, 1}), 32 - 4, 1e-13);    // through it
  EXPECT_NEAR(shell.chord({2, 2, 2}, {0, 0, 1}), 0.5, 1e-14);           // the inner box, on the same plane
  EXPECT_EQ(shell.cuts(), 2U);
}

TEST(ClipOracle, SaysWhenThePointIsNotInside) {
  ClipOracle box(core::make_box(1, 2, 3));
  EXPECT_THROW(box.chord({1.5, 0.5, 0.5}, {0, 0, 1}), std::runtime_error);
  EXPECT_THROW(ClipOracle(core::reversed(core::make_box(1, 1, 1))), std::invalid_argument);
}

// Cells of a grid, full or empty, with sides from 0.2 to 2; nothing if parts of it only touch.
std::optional<Mesh> random_blocks(std::mt19937_64& random) {
  fuzz::BlockSolid blocks;
  for (std::vector<double>& planes : blocks.planes) {
    planes = {0};
    for (std::size_t cells = 1 + random() % 4; cells > 0; --cells)
      planes.push_back(planes.back() + std::array{1.0, 0.5, 2.0, 0.2}[random() % 4]);
  }
  for (std::size_t c = blocks.cells(0) * blocks.cells(1) * blocks.cells(2); c > 0; --c)
    blocks.full.push_back(random() % 4 != 0);
  if (blocks.volume() == 0) return {};
  Mesh mesh = blocks.mesh();
  bool touches = false;
  core::Edges(mesh.points.size(), mesh.triangles)
      .for_each([&](std::uint32_t, std::uint32_t, std::span<const core::EdgeSide> sides) {
        touches = touches || sides.size() > 2;
      });
  if (touches) return {};
  const core::Solid solid = core::make_solid(mesh);
  touches = std::ranges::any_of(solid.notes,
                                [](const core::MeshNote& note) { return note.code == "split-vertices"; });
  return touches ? std::nullopt : std::optional(std::move(mesh));
}

TEST(ClipOracle, TwoHundredRandomSolidsOfBlocks) {
  std::mt19937_64 random(33);
  std::size_t solids = 0;
  while (solids < 200) {
    const std::optional<Mesh> mesh = random_blocks(random);
    if (!mesh) continue;
    Plan plan{"blocks " + std::to_string(solids++), *mesh, 0, 1, 1, {}, 2};
    const core::Solid solid = core::make_solid(*mesh);
    plan.spacing = std::cbrt(solid.volume / 200);
    compare(plan);
  }
}

}  // namespace
}  // namespace affskel::reference
