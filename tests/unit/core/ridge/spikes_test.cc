#include "core/ridge/spikes.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "core/collapse/lattice_solids.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/ridge/local_depth.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

// A beam along x, the box's low corner at the origin, 40 spacings long; its tips are the lattice's first and last
// vertices.
struct Beam {
  LatticeSolid solid{make_box(20, 2, 2, 20), 0.5};
  DualComplex complex{solid.lattice};
  std::vector<float> radius = surface_distance(solid.lattice);
  std::vector<float> thickness;
  std::vector<LimbTip> tips{2};

  explicit Beam(float thick) : thickness(solid.lattice.points, thick) {
    tips[0].vertex = complex.cell(0, DualComplex::kUpperVertex);
    complex.for_each_cell([&](Cell cell) {
      if (DualComplex::dimension(cell) == 0 && complex.star(cell).count == 8) tips[1].vertex = cell;
    });
  }

  SpikyLimbs limbs(double noise = 5) const { return {complex, radius, thickness, tips, noise}; }

  Mesh walls() const { return surface_in_lattice(solid.solid, solid.lattice); }

  // The last tip's vertex alone.
  CellSet skeleton() const {
    CellSet cells(complex);
    cells.insert(tips[1].vertex);
    return cells;
  }
};

// Of the triangles within 8 spacings of the first tip, which are three in ten of all, every n-th crosses itself.
void cross_near_first_tip(Beam& beam, const Mesh& walls, std::uint32_t n) {
  for (std::uint32_t t = 0; t < walls.triangles.size(); t += n) {
    const auto& [a, b, c] = walls.triangles[t];
    if ((walls.points[a].x + walls.points[b].x + walls.points[c].x) / 3 < 8)
      beam.solid.solid.crossings.emplace_back(t, t);
  }
}

TEST(Spikes, MayBeWhereTheSurfaceCrossesItselfAboutATip) {
  Beam beam(2);
  const Mesh walls = beam.walls();
  const auto possible = [&](double noise = 5) {
    return possible_spikes(beam.solid.solid, walls, beam.solid.lattice, beam.limbs(noise));
  };
  EXPECT_TRUE(possible().empty());
  cross_near_first_tip(beam, walls, 4);
  EXPECT_EQ(possible(), (std::vector<char>{1, 0}));
  beam.tips[0].length = 3;
  EXPECT_EQ(possible(0.51), (std::vector<char>{1, 0}));
  EXPECT_EQ(possible(0.49), (std::vector<char>{0, 0})) << "longer than noise pulls spikes out";
  beam.tips[0].length = 1 + 1.2 * 2 + 0.01;
  EXPECT_EQ(possible(), (std::vector<char>{0, 0}));
}

// Parts put together, as a stool's legs and seat.
TEST(Spikes, AreNoLimbsOfPartsThatOverlap) {
  Beam beam(2);
  const Mesh walls = beam.walls();
  cross_near_first_tip(beam, walls, 1);
  Solid& solid = beam.solid.solid;
  for (auto& [a, b] : solid.crossings) b = a == 0 ? 1 : 0;
  EXPECT_FALSE(possible_spikes(solid, walls, beam.solid.lattice, beam.limbs()).empty());
  for (std::uint32_t t = 0; t < solid.triangle_shell.size(); ++t) solid.triangle_shell[t] = t;
  EXPECT_TRUE(possible_spikes(solid, walls, beam.solid.lattice, beam.limbs()).empty());
}

TEST(Spikes, MayBeAnywhereWhereAFifthOfTheSurfaceCrossesItself) {
  Beam beam(2);
  const Mesh walls = beam.walls();
  cross_near_first_tip(beam, walls, 1);
  beam.tips[0].length = beam.tips[1].length = 3;
  const auto possible = [&](double noise) {
    return possible_spikes(beam.solid.solid, walls, beam.solid.lattice, beam.limbs(noise));
  };
  EXPECT_EQ(possible(0.51), (std::vector<char>{1, 1}));
  EXPECT_EQ(possible(0.49), (std::vector<char>{0, 0}));
}

// 38 spacings from the skeleton: as far as a spike of that length may be from that of a limb 15 thick.
TEST(Spikes, AreNoLongerThanTheirLimbIsThick) {
  Beam beam(15.5);
  beam.tips.resize(1);
  const CellSet skeleton = Beam(15.5).skeleton();
  const auto limbs = [&](double length) {
    beam.tips[0].length = length;
    return limbs_without_spikes(beam.limbs(), skeleton).size();
  };
  EXPECT_EQ(limbs(19), 0U);
  EXPECT_EQ(limbs(20), 1U) << "longer than 1 + 1.2 * 15.5";
  EXPECT_EQ(limbs(15), 1U) << "farther away than 15 + 19.6";
  beam.tips.clear();
  EXPECT_EQ(limbs_without_spikes(beam.limbs(), skeleton).size(), 0U);
}

}  // namespace
}  // namespace affskel::core
