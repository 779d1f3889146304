#include "core/chords/equal_chords.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/barrier/barriers.h"
#include "core/base/unit.h"
#include "core/chords/chord_fields.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// A refined field, with its shocks where tangents cross and where chords are equal.
struct Placed {
  ErodedSolid eroded;
  PieceInput input;
  std::vector<ChordShock> crossing, equal;

  Placed(const Mesh& mesh, const std::array<Vec3, 3>& axes)
      : eroded(mesh, axes, "triangles+sphere:200", true),
        input(eroded.solid),
        crossing(chord_shocks(eroded.lattice, eroded.field, constants_of_infimum())),
        equal(placed(1)) {}

  std::vector<ChordShock> placed(unsigned threads) const {
    std::vector<ChordShock> shocks = crossing;
    place_at_equal_chords(eroded.solid, eroded.lattice, eroded.field, {input, eroded.saddles, threads},
                          shocks, nullptr);
    return shocks;
  }

  // By the sphere of directions, which knows nothing of descents.
  std::vector<double> barriers_of_shocks() const {
    const Matrix3 normals = inverse_transposed(frame_matrix(eroded.lattice));
    std::vector<SheetPlace> places;
    for (const ChordShock& shock : equal) {
      places.push_back({scaled_from_frame(eroded.lattice, shock.position), unit(normals * shock.gradient_low),
                        unit(normals * shock.gradient_high)});
    }
    return barriers(eroded.solid, places, {.directions = 10242});
  }
};

Mesh tetrahedron_off_the_lattice() {
  Mesh mesh = make_tetrahedron(2);
  for (Vec3& p : mesh.points) p = {p.x + 0.013, p.y - 0.007 + 0.1 * p.z, p.z - 0.1 * p.y};
  return mesh;
}

// Distance from the nearest of the six planes that mirror a tetrahedron, whatever map it has been through: two of the
// barycentric coordinates agree there.
double off_mirrors(const Mesh& tetrahedron, const Vec3& p) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c) { return dot(a, cross(b, c)); };
  std::array<double, 4> weight{};
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto corner = [&](std::size_t n) { return tetrahedron.points[(k + n) % 4] - p; };
    weight[k] = std::abs(volume(corner(1), corner(2), corner(3)));
    sum += weight[k];
  }
  double least = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) least = std::min(least, std::abs(weight[i] - weight[j]) / sum);
  }
  return least;
}

// Chords are equal where the mirror of one is the other.  E is cubic, so tangents miss that.
TEST(EqualChords, OfATetrahedronLieOnItsMirrorsToAllDigits) {
  const Mesh mesh = tetrahedron_off_the_lattice();
  const Placed placed(mesh, cubic_axes(0.07));
  std::size_t strict = 0, far_before = 0;
  for (std::size_t s = 0; s < placed.equal.size(); ++s) {
    const ChordShock& shock = placed.equal[s];
    if (shock.turns) continue;
    ++strict;
    far_before += off_mirrors(mesh, placed.eroded.place(placed.crossing[s].position)) > 1e-4 ? 1 : 0;
    EXPECT_LT(off_mirrors(mesh, placed.eroded.place(shock.position)), 1e-7);
  }
  EXPECT_GT(strict, 100U);
  EXPECT_GT(far_before, strict / 2);
}

// E beside the shock, from both sides, goes on to what it says of its place.
TEST(EqualChords, TellEAndBothGradientsAtTheirPlace) {
  const Placed placed(tetrahedron_off_the_lattice(), cubic_axes(0.07));
  const double volume = placed.eroded.solid.volume;
  for (const ChordShock& shock : placed.equal) {
    if (shock.turns) continue;
    ChordDescent descent(placed.input);
    for (const Vec3& gradient : {shock.gradient_low, shock.gradient_high}) {
      const Vec3 x = scaled_from_frame(placed.eroded.lattice, shock.position);
      const LeastChord piece = descent.descend(x, {.normal = unit(gradient)});
      EXPECT_NEAR(std::ldexp(piece.erosion, 3 * placed.eroded.solid.exponent) / volume,
                  shock.erosion / volume, 1e-9);
      EXPECT_NEAR(std::ldexp(piece.slope, 2 * placed.eroded.solid.exponent) / norm(gradient), 1, 1e-4);
    }
  }
}

// Where two minima are found there is a barrier between them, and where one is found there is none; near the surface
// the grain of the sphere makes some.
TEST(EqualChords, AgreeWithTheBarriersOnTheSphere) {
  for (const Mesh& mesh : {tetrahedron_off_the_lattice(), make_torus(4, 2, 256)}) {
    const Placed placed(mesh, cubic_axes(mesh.points.size() == 4 ? 0.07 : 0.4));
    const std::vector<double> barrier = placed.barriers_of_shocks();
    std::size_t high = 0, high_of_strict = 0, strict = 0, low_of_strict = 0;
    for (std::size_t s = 0; s < barrier.size(); ++s) {
      const ChordShock& shock = placed.equal[s];
      if (shock.erosion < 0.02 * placed.eroded.solid.volume) continue;
      strict += shock.turns ? 0 : 1;
      low_of_strict += !shock.turns && barrier[s] < 1e-4 ? 1 : 0;
      high += barrier[s] > 0.02 ? 1 : 0;
      high_of_strict += !shock.turns && barrier[s] > 0.02 ? 1 : 0;
    }
    EXPECT_GT(high, 40U);
    EXPECT_EQ(high_of_strict, high);
    EXPECT_LE(20 * low_of_strict, strict);
  }
}

// All planes through a place on the axis of a tube cut off as much: nothing jumps.
TEST(EqualChords, TurnInAnEllipsoid) {
  const Placed placed(make_ellipsoid(3, 2, 1, 1280), cubic_axes(0.17));
  ASSERT_FALSE(placed.equal.empty());
  std::size_t strict = 0;
  for (std::size_t s = 0; s < placed.equal.size(); ++s) {
    strict += placed.equal[s].turns ? 0 : 1;
    if (placed.equal[s].turns) {
      EXPECT_EQ(placed.equal[s].t, placed.crossing[s].t);
    }
  }
  EXPECT_LE(50 * strict, placed.equal.size());
}

TEST(EqualChords, DoNotDependOnThreads) {
  const Placed placed(make_torus(4, 2, 256), cubic_axes(0.4));
  const std::vector<ChordShock> by_three = placed.placed(3);
  ASSERT_EQ(by_three.size(), placed.equal.size());
  for (std::size_t s = 0; s < by_three.size(); ++s) {
    EXPECT_EQ(by_three[s].position, placed.equal[s].position);
    EXPECT_EQ(by_three[s].erosion, placed.equal[s].erosion);
    EXPECT_EQ(by_three[s].turns, placed.equal[s].turns);
  }
}

}  // namespace
}  // namespace affskel::core
