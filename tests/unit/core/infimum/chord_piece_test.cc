// The planes' pieces against the join tree, which finds them in another way, and their derivatives against
// differences.
#include "core/infimum/chord_piece.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/unit.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/infimum/piece_input.h"
#include "core/infimum/samples.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

struct Case {
  std::string name;
  Mesh mesh;
};

std::vector<Case> cases() {
  return {{"ball", make_sphere(1, 500)},
          {"torus", shaken(make_torus(3, 1, 256), 0, 1)},
          {"cup", shaken(cup(24), 0, 2)},
          {"comb", shaken(comb(5), 0, 3)},
          {"hollow ball", hollow_ball()},
          {"two balls", joined(make_sphere(1, 80), moved(make_sphere(1, 200), {3, 0, 0}))},
          {"overlapping boxes", shaken(overlapping_boxes(4, 5, 6), 0, 4)},
          {"body", make_body({.triangles = 1000})}};
}

void expect_as_the_trees(const Case& c) {
  SCOPED_TRACE(c.name);
  const Solid solid = make_solid(c.mesh);
  const Lattice lattice = lattice_of_points(solid, 400);
  const std::vector<Vec3> places = places_of(lattice);
  const PieceInput input(solid);
  PieceFinder finder(input);
  for (const Vec3& d : make_directions(solid, "random:60:7")) {
    const DirectionSet one{d};
    Erosion erosion(solid, lattice, one, {});
    ExecutionContext context;
    erosion.run(std::vector<std::uint32_t>{0}, context);
    for (std::uint32_t p = 0; p < lattice.points; ++p) {
      const FieldValue tree = erosion.field().value(p);
      const ChordPiece piece = finder.find(places[p], d);
      ASSERT_TRUE(piece.found);
      ASSERT_NEAR(piece.volume, tree.erosion, 1e-10 * input.volume + 1e-10 * tree.erosion) << p;
      ASSERT_NEAR(piece.area, tree.area, 1e-7) << p;
    }
  }
}

TEST(ChordPieceTest, VolumesAndAreasAreTheJoinTrees) {
  for (const Case& c : cases()) expect_as_the_trees(c);
}

TEST(ChordPieceTest, DerivativesAreThoseOfTheVolume) {
  const Solid solid = make_solid(make_body({.triangles = 1000}));
  const PieceInput input(solid);
  PieceFinder finder(input);
  const std::vector<Vec3> places = places_of(lattice_of_points(solid, 100));
  constexpr double kStep = 1e-5;
  int compared = 0;
  for (const std::size_t p : {5U, 40U, 80U}) {
    const Vec3& x = places[p];
    for (const Vec3& d : make_directions(solid, "random:40:3")) {
      const ChordPiece at = finder.find(x, d);
      const Hessian hessian = finder.hessian();
      const auto tilted = [&](double s, double t) { return finder.find(x, unit(d + (s * at.u + t * at.w))); };
      const ChordPiece right = tilted(kStep, 0), left = tilted(-kStep, 0), up = tilted(0, kStep),
                       down = tilted(0, -kStep);
      // Beside a saddle the volume jumps.
      if (std::abs(right.volume - left.volume) + std::abs(up.volume - down.volume) > 1e-4) continue;
      ++compared;
      EXPECT_NEAR((right.volume - left.volume) / (2 * kStep), at.gradient[0], 1e-6);
      EXPECT_NEAR((up.volume - down.volume) / (2 * kStep), at.gradient[1], 1e-6);
      EXPECT_NEAR((right.volume - 2 * at.volume + left.volume) / (kStep * kStep), hessian[0], 2e-3);
      EXPECT_NEAR((up.volume - 2 * at.volume + down.volume) / (kStep * kStep), hessian[2], 2e-3);
      const double mixed = tilted(kStep, kStep).volume - tilted(kStep, -kStep).volume -
                           tilted(-kStep, kStep).volume + tilted(-kStep, -kStep).volume;
      EXPECT_NEAR(mixed / (4 * kStep * kStep), hessian[1], 2e-3);
    }
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace affskel::core
