#include "core/collapse/collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/execution_context.h"
#include "core/base/split_mix64.h"
#include "core/chords/chord_fields.h"
#include "core/collapse/lattice_solids.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/lattice_points.h"
#include "core/quality/sheet_topology.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

std::uint64_t count(const CellSet& cells, int dimension) {
  std::uint64_t result = 0;
  cells.for_each([&](Cell cell) { result += DualComplex::dimension(cell) == dimension; });
  return result;
}

// Betti numbers by elimination on what is left, against those of the complex by its boundary: whatever is
// anchored, a collapse keeps them.
TEST(Collapse, KeepsTheTopologyOfRandomSolidsOntoRandomAnchors) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.17);
    const DualComplex complex(solid.lattice);
    std::vector<Cell> cells;
    complex.for_each_cell([&](Cell cell) {
      if (DualComplex::dimension(cell) < 3) cells.push_back(cell);
    });
    SplitMix64 random(seed);
    std::vector<Anchor> anchors;
    const std::uint64_t wanted = random.next() % 60;
    for (std::uint64_t n = 0; n < wanted; ++n)
      anchors.push_back({cells[random.next() % cells.size()], static_cast<float>(random.next() % 8)});
    const Collapsed left = collapse(complex, anchors);
    const CellMesh mesh = mesh_of_cells(complex, left.cells);
    EXPECT_EQ(mesh.cubes, 0U) << seed;
    const BettiNumbers found = sheet_betti_numbers(mesh.mesh, mesh.segments);
    EXPECT_EQ(found, betti_numbers(complex)) << seed;
    EXPECT_EQ(count_components(complex, left.cells), betti_numbers(complex).components) << seed;
    if (left.opened > 0) continue;
    for (const Anchor& anchor : anchors) EXPECT_TRUE(left.cells.has(anchor.cell)) << seed;
  }
}

TEST(Collapse, WithoutAnchorsLeavesAVertexACircleOrASurface) {
  const LatticeSolid ball(make_sphere(1, 320), 0.15);
  const DualComplex of_ball(ball.lattice);
  const CellSet point = collapse(of_ball, {}).cells;
  EXPECT_EQ(count(point, 0), 1U);
  EXPECT_EQ(count(point, 1), 0U);
  const LatticeSolid torus(make_torus(3, 1, 512), 0.3);
  const DualComplex of_torus(torus.lattice);
  const CellSet circle = collapse(of_torus, {}).cells;
  EXPECT_EQ(count(circle, 2), 0U);
  EXPECT_EQ(count(circle, 0), count(circle, 1));
}

// The cubes within six anchored faces have no way out but through the lightest of them.
TEST(Collapse, OpensAPocketAtItsLightestSquare) {
  const BoxLattice box(7, 7, 7);
  const DualComplex complex(box.lattice);
  const auto cube = [](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return 49 * i + 7 * j + k; };
  std::vector<Anchor> anchors;
  for (std::uint32_t a = 2; a <= 4; ++a) {
    for (std::uint32_t b = 2; b <= 4; ++b) {
      for (const std::uint32_t end : {1U, 4U}) {
        anchors.push_back({complex.square(cube(end, a, b), 0), 5});
        anchors.push_back({complex.square(cube(a, end, b), 1), 5});
        anchors.push_back({complex.square(cube(a, b, end), 2), 5});
      }
    }
  }
  anchors[17].weight = 1;
  const Collapsed left = collapse(complex, anchors);
  EXPECT_EQ(left.opened, 1U);
  EXPECT_FALSE(left.cells.has(anchors[17].cell));
  EXPECT_EQ(count(left.cells, 2), 53U);
  EXPECT_EQ(count(left.cells, 3), 0U);
}

// Two squares at the ends of a bar: a way of edges between them, as short as can be, where it costs least.
TEST(Collapse, JoinsAnchorsByTheCheapestWay) {
  const BoxLattice bar(21, 5, 5);
  const DualComplex complex(bar.lattice);
  const auto cube = [](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return 25 * i + 5 * j + k; };
  const std::vector<Anchor> anchors{{complex.square(cube(2, 2, 2), 0), 1},
                                    {complex.square(cube(18, 2, 2), 0), 1}};
  std::vector<float> cost(complex.cubes(), 3);
  for (std::uint32_t i = 0; i < 21; ++i) cost[cube(i, 2, 2)] = 1;
  const Collapsed left = collapse(complex, anchors, {.cost = cost});
  EXPECT_EQ(count(left.cells, 2), 2U);
  EXPECT_EQ(count(left.cells, 1), 8U + 16U);
  left.cells.for_each([&](Cell cell) {
    bool beside = false;
    for (const auto& member : complex.star(cell)) beside = beside || member.cube % 25 == cube(0, 2, 2);
    EXPECT_TRUE(beside);
  });
}

// From a tip in a corner of a bar, in which ways cost more and more towards the walls and the tip's end, a line leads to
// the end of the strip in its middle: it does not slide along the walls beside the strip.
TEST(Collapse, LeadsLinesOffTheWalls) {
  const std::uint32_t wide = 9, strip = 20;
  const BoxLattice bar(34, wide, wide);
  const DualComplex complex(bar.lattice);
  const auto cube = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return wide * (wide * i + j) + k;
  };
  std::vector<Anchor> anchors{{complex.cell(cube(30, 0, 0), DualComplex::kUpperVertex), 0, true}};
  for (std::uint32_t i = 0; i < strip; ++i)
    for (std::uint32_t k = 3; k <= 5; ++k) anchors.push_back({complex.square(cube(i, 4, k), 1), 1});
  std::vector<float> cost;
  for (std::uint32_t i = 0; i < 34; ++i) {
    for (std::uint32_t j = 0; j < wide; ++j) {
      for (std::uint32_t k = 0; k < wide; ++k) {
        const double off_wall = std::min({j, k, wide - 1 - j, wide - 1 - k}) + 0.5;
        cost.push_back(static_cast<float>(std::exp(0.1 * i) * 4 / off_wall));
      }
    }
  }
  const CellSet left = collapse(complex, anchors, {.cost = cost}).cells;
  std::size_t line = 0;
  left.for_each([&](Cell cell) {
    if (DualComplex::dimension(cell) == 1 && is_bare(complex, cell, left)) ++line;
  });
  EXPECT_LE(line, (30 - strip + 1) + 4 + 3U);  // so many edges lead to the middle of the strip's end; 37 slid
}

// A tip at the outer wall of a ring, which a square across from it anchors: a line leads to it, and the ring's own line
// does not run there and back.
TEST(Collapse, LeadsOneLineToATip) {
  const LatticeSolid ring(make_torus(3, 1, 2048), 0.25);
  const DualComplex complex(ring.lattice);
  const SamplePlaces places(ring.solid, ring.lattice);
  const auto cube_at = [&](double angle, double radius) {
    const Vec3 wanted{radius * std::cos(angle), radius * std::sin(angle), 0};
    std::pair nearest(HUGE_VAL, 0U);
    for_each_point(ring.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      nearest = std::min(nearest, std::pair(norm(places.at(i, j, k) - wanted), rank));
    });
    return nearest.second;
  };
  for (const double angle : {1.8, 2.2, 2.6, 3.0}) {
    const Cell tip = complex.cell(cube_at(angle, 3.6), DualComplex::kUpperVertex);
    const std::vector<Anchor> anchors{{complex.square(cube_at(0, 3), 0), 1}, {tip, 0, true}};
    const CellSet left = collapse(complex, anchors).cells;
    std::size_t edges = 0;
    for (const Cell edge : complex.cofaces(tip)) edges += left.has(edge);
    EXPECT_EQ(edges, 1U) << angle;
  }
}

TEST(Collapse, StopsWhenItsContextAsks) {
  struct Stopped : ExecutionContext {
    bool stop_requested() override { return true; }
  } context;
  const BoxLattice box(9, 9, 9);
  EXPECT_THROW(collapse(DualComplex(box.lattice), {}, {.cost = {}, .context = &context}), CoreError);
}

}  // namespace
}  // namespace affskel::core
