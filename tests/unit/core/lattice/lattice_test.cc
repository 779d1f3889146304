#include "core/lattice/lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/lattice/all_places.h"
#include "core/lattice/scan_conversion.h"
#include "core/mesh_checks.h"
#include "core/shapes/shapes.h"
#include "core/stopping_context.h"

namespace affskel::core {
namespace {

Lattice lattice_of(const Solid& solid, double spacing) {
  LatticeOptions options;
  options.spacing = spacing;
  return make_lattice(solid, options);
}

std::vector<Vec3> places_of(const Solid& solid, const Lattice& lattice) {
  std::uint32_t points = 0;
  for (const LatticeRun& run : lattice.axis[2].runs) {
    EXPECT_EQ(run.first, points);
    points += run.length;
  }
  EXPECT_EQ(points, lattice.points);
  return all_places(solid, lattice);
}

TEST(MakeLattice, FillsABoxSymmetrically) {
  const Solid solid = make_solid(make_box(3, 2, 1));
  const Lattice lattice = lattice_of(solid, 0.25);
  EXPECT_EQ(lattice.points, 12U * 8 * 4);
  const std::vector<Vec3> places = places_of(solid, lattice);
  EXPECT_NEAR(places.front().x, 0.125, 1e-15);
  EXPECT_NEAR(places.back().x, 2.875, 1e-15);
  EXPECT_NEAR(places.front().z, 0.125, 1e-15);
  EXPECT_NEAR(places.back().z, 0.875, 1e-15);
}

TEST(MakeLattice, KeepsExactlyThePointsInside) {
  const Mesh mesh = make_torus(3, 1, 512);
  const Solid solid = make_solid(mesh);
  const Lattice lattice = lattice_of(solid, 0.37);
  std::set<std::array<double, 3>> kept;
  for (const Vec3& p : places_of(solid, lattice)) kept.insert({p.x, p.y, p.z});
  const SamplePlaces places(solid, lattice);
  std::size_t inside = 0;
  for (std::uint32_t i = 0; i < lattice.grid.dims[0]; ++i) {
    for (std::uint32_t j = 0; j < lattice.grid.dims[1]; ++j) {
      for (std::uint32_t k = 0; k < lattice.grid.dims[2]; ++k) {
        const Vec3 p = places.at(i, j, k);
        const bool wanted = winding_number(mesh, p) > 0.5;
        inside += wanted;
        EXPECT_EQ(kept.count({p.x, p.y, p.z}), wanted ? 1U : 0U) << p.x << " " << p.y << " " << p.z;
      }
    }
  }
  EXPECT_GT(inside, 1000U);
}

// Every run, along any axis, ends on triangles that its end points see along the axis with nothing between.
TEST(MakeLattice, RunsOfAllAxesHoldEveryPointOnce) {
  const Solid solid = make_solid(make_torus(3, 1, 512));
  const Lattice lattice = lattice_of(solid, 0.2);
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisRuns& axis = lattice.axis[a];
    std::vector<int> seen(lattice.points, 0);
    for (const LatticeRun& run : axis.runs) {
      for (std::uint32_t n = run.first; n < run.first + run.length; ++n)
        ++seen[axis.order.empty() ? n : axis.order[n]];
    }
    for (const LatticeRun& stray : axis.strays) ++seen[stray.first];
    for (int count : seen) ASSERT_EQ(count, 1);
  }
}

// A lattice with places in the faces of a slanting box: rounding has them inside along one axis and outside along another.
TEST(MakeLattice, StraysLieOnTheirRunOfAxis2) {
  const Vec3 u{0.8, 0.36, 0.48}, v{-0.6, 0.48, 0.64}, w = cross(u, v);
  Mesh box = make_box(1, 1, 1);
  for (Vec3& p : box.points) p = (p.x - 0.5) * u + (p.y - 0.5) * v + (p.z - 0.5) * w;
  const Solid solid = make_solid(box);
  const double step = 0.1 / solid.scale();
  LatticeGrid grid{{}, {step * u, step * v, step * w}, {11, 11, 11}};
  grid.origin = -5.0 * (grid.axes[0] + grid.axes[1] + grid.axes[2]);
  const Lattice lattice = make_lattice(solid, grid);
  std::size_t strays = 0;
  for (const int axis : {0, 1}) {
    for (const LatticeRun& stray : lattice.axis[axis].strays) {
      ++strays;
      for (const LatticeRun& run : lattice.axis[2].runs) {
        if (stray.first < run.first || stray.first >= run.first + run.length) continue;
        EXPECT_EQ(stray.low, run.low);
        EXPECT_EQ(stray.high, run.high);
        const std::array<std::uint32_t, 3> place{run.start[0], run.start[1],
                                                 run.start[2] + stray.first - run.first};
        EXPECT_EQ(stray.start, place);
      }
    }
  }
  EXPECT_GT(strays, 0U);
}

TEST(MakeLattice, RunsEndAtTheSurface) {
  const double r = 1;
  const Solid solid = make_solid(make_sphere(r, 5120));
  const Lattice lattice = lattice_of(solid, 0.1);
  const SamplePlaces places(solid, lattice);
  for (std::size_t a = 0; a < 3; ++a) {
    for (const LatticeRun& run : lattice.axis[a].runs) {
      std::array<std::uint32_t, 3> end = run.start;
      const Vec3 first = places.at(end[0], end[1], end[2]);
      end[a] += run.length - 1;
      const Vec3 last = places.at(end[0], end[1], end[2]);
      EXPECT_LE(norm(first), r);
      EXPECT_LE(norm(last), r);
      Vec3 step{a == 0 ? 0.1 : 0.0, a == 1 ? 0.1 : 0.0, a == 2 ? 0.1 : 0.0};
      EXPECT_GT(norm(first - step), 0.99 * r);
      EXPECT_GT(norm(last + step), 0.99 * r);
      // The end triangles are the ones met: their corners are near the ends of the run.
      const Vec3 corner = solid.scale() * solid.mesh.points[solid.mesh.triangles[run.low][0]] + solid.centre;
      EXPECT_LT(norm(corner - first), 0.25 + norm(step));
    }
  }
}

TEST(MakeLattice, AimsAtTheNumberOfPoints) {
  const Solid solid = make_solid(make_torus(6000, 2500, 256));
  LatticeOptions options;
  options.target_points = 20000;
  EXPECT_NEAR(make_lattice(solid, options).points, 20000, 600);
}

TEST(MakeLattice, RefusesWhatCannotBe) {
  const Solid solid = make_solid(make_box(3, 2, 1));
  const auto code = [&](double spacing) {
    try {
      lattice_of(solid, spacing);
      return CoreError::Code::kInternal;
    } catch (const CoreError& error) {
      return error.code();
    }
  };
  EXPECT_EQ(code(-1), CoreError::Code::kBadInput);
  EXPECT_EQ(code(std::nan("")), CoreError::Code::kBadInput);
  EXPECT_EQ(code(1e-6), CoreError::Code::kLimit);
  EXPECT_EQ(code(1e-300), CoreError::Code::kLimit);
  // A thin shell that every lattice point misses.
  Mesh shell = make_sphere(1, 320);
  const Mesh inner = make_sphere(0.999, 320);
  for (const Vec3& p : inner.points) shell.points.push_back(p);
  for (const Triangle& t : inner.triangles) shell.triangles.push_back({t[0] + 162, t[2] + 162, t[1] + 162});
  try {
    lattice_of(make_solid(shell), 2);
    FAIL();
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kBadInput);
  }
}

// Lines through edges and vertices: the lattice of a box cut into triangles whose corners are lattice points.
TEST(ScanConversion, EveryLineLeavesAsOftenAsItEnters) {
  for (std::uint32_t divisions : {1U, 3U, 8U}) {
    const Solid solid = make_solid(make_box(1, 1, 1, divisions));
    LatticeGrid grid;
    grid.origin = {-0.5, -0.5, -0.5};
    grid.axes = {Vec3{0.125, 0, 0}, Vec3{0, 0.125, 0}, Vec3{0, 0, 0.125}};
    grid.dims = {9, 9, 9};
    for (int axis = 0; axis < 3; ++axis) {
      const LineCrossings lines = scan_convert(solid.mesh, grid, axis);
      for (std::size_t line = 0; line + 1 < lines.begin.size(); ++line) {
        int winding = 0;
        for (std::uint64_t c = lines.begin[line]; c < lines.begin[line + 1]; ++c) {
          winding -= lines.crossings[c].exits;
          EXPECT_GE(winding, 0);
        }
        EXPECT_EQ(winding, 0);
      }
    }
    // Half-open on every axis: of 9 planes of points the 8 lower ones are inside.
    EXPECT_EQ(make_lattice(solid, grid).points, 512U);
  }
}

TEST(ScanConversion, OfTheLinesMetFindsTheSameCrossings) {
  // Lattice points on the faces of the box, so that many crossings of a line coincide.
  const Solid solid = make_solid(make_box(1, 1, 1, 3));
  LatticeGrid grid;
  grid.origin = {-1, -0.75, -0.5};
  grid.axes = {Vec3{0.125, 0, 0}, Vec3{0.125, 0.125, 0}, Vec3{0, 0.125, 0.125}};
  grid.dims = {15, 17, 9};
  for (int axis = 0; axis < 3; ++axis) {
    const LineCrossings all = scan_convert(solid.mesh, grid, axis);
    std::size_t next = 0;
    const std::vector<CrossingOnLine> met = scan_convert_lines_met(solid.mesh, grid, axis);
    ASSERT_EQ(met.size(), all.crossings.size());
    EXPECT_GT(met.size(), 50u);
    for (std::size_t line = 0; line + 1 < all.begin.size(); ++line) {
      for (std::uint64_t c = all.begin[line]; c < all.begin[line + 1]; ++c, ++next) {
        EXPECT_EQ(met[next].line, line);
        EXPECT_EQ(met[next].crossing.depth, all.crossings[c].depth);
        EXPECT_EQ(met[next].crossing.triangle, all.crossings[c].triangle);
        EXPECT_EQ(met[next].crossing.exits, all.crossings[c].exits);
      }
    }
  }
}

TEST(ScanConversion, TakesObliqueAndLeftHandedFrames) {
  const Solid solid = make_solid(make_sphere(1, 1280));
  LatticeGrid grid;
  grid.axes = {Vec3{0.05, 0.01, 0}, Vec3{0, 0, 0.04}, Vec3{0.02, 0.05, 0.01}};  // left-handed
  grid.dims = {60, 60, 60};
  grid.origin = -30.0 * (grid.axes[0] + grid.axes[1] + grid.axes[2]);
  const double cell = std::abs(dot(grid.axes[0], cross(grid.axes[1], grid.axes[2])));
  const double inner_volume = solid.volume / std::pow(solid.scale(), 3);
  EXPECT_NEAR(make_lattice(solid, grid).points * cell / inner_volume, 1, 0.02);
}

TEST(MakeLattice, StopsWhereverItIsAsked) {
  const Solid solid = make_solid(make_sphere(3000, 1280));
  LatticeOptions options;
  options.target_points = 300000;
  expect_stops_wherever_it_is_asked(20, [&](ExecutionContext* context) {
    options.context = context;
    make_lattice(solid, options);
  });
}

TEST(MakeLattice, IsTheSameWithAContext) {
  const Solid solid = make_solid(make_torus(3, 1, 512));
  LatticeOptions options;
  options.spacing = 0.03;
  options.threads = 2;
  const Lattice plain = make_lattice(solid, options);
  StoppingContext context;
  options.context = &context;
  const Lattice asked = make_lattice(solid, options);
  EXPECT_GT(context.asked(), 10U);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_TRUE(plain.axis[a].order == asked.axis[a].order);
    ASSERT_EQ(plain.axis[a].runs.size(), asked.axis[a].runs.size());
    for (std::size_t r = 0; r < plain.axis[a].runs.size(); ++r) {
      const LatticeRun &p = plain.axis[a].runs[r], &q = asked.axis[a].runs[r];
      ASSERT_TRUE(p.first == q.first && p.length == q.length && p.low == q.low && p.high == q.high &&
                  p.start == q.start);
    }
  }
}

}  // namespace
}  // namespace affskel::core
