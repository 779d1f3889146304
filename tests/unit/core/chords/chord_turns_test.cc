#include "core/chords/chord_turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/chords/chord_fields.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

constexpr double kPi = 3.14159265358979323846;

// E falls in slope from layer to layer of z: normals at angles to the x axis that the layers are given.
FrameField layered(const Lattice& lattice, const std::vector<double>& angle) {
  FrameField field = field_of_branches(lattice, {linear_branch(1, {0, 0, 1})});
  const auto layers = static_cast<std::uint32_t>(angle.size());
  for (std::uint32_t p = 0; p < lattice.points; ++p) {
    const double a = angle[p % layers];
    field.direction[p] = p % layers;
    field.gradient[p] = {std::cos(a), 0, std::sin(a)};
    double erosion = 10;
    for (std::uint32_t k = 0; k < p % layers; ++k)
      erosion += 0.5 * (std::sin(angle[k]) + std::sin(angle[k + 1]));
    field.erosion[p] = erosion;
  }
  return field;
}

std::vector<ChordShock> turned(const BoxLattice& box, const FrameField& field,
                               const ChordConstants& constants) {
  std::vector<ChordShock> shocks = chord_shocks(box.lattice, field);
  std::erase_if(shocks, [](const ChordShock& s) { return s.axis != 2; });
  measure_turns(box.lattice, SolidParts(box.solid, box.lattice), field, shocks, nullptr, constants);
  return shocks;
}

// E is 10 to 13 in these fields, |g| and h are 1, so that the depth d is 10 to 13, too: 0.45 of it are about
// 5 edges, the shock's own and (rounded) two to either side.
ChordConstants unaveraged(double width = 0.45) {
  ChordConstants constants;
  constants.width = width;
  constants.rounds = 0;
  return constants;
}

// A jump from +60 to -60 degrees in three steps of 30, 60 and 30: the middle one speaks for 120 degrees.
void expect_the_middle_to_speak(const BoxLattice& box) {
  const double d = kPi / 180;
  const FrameField field =
      layered(box.lattice, {60 * d, 60 * d, 60 * d, 30 * d, -30 * d, -60 * d, -60 * d, -60 * d, -60 * d});
  const std::vector<ChordShock> shocks = turned(box, field, unaveraged());
  ASSERT_EQ(shocks.size(), 3 * 25U);
  for (const ChordShock& shock : shocks) {
    const bool middle = shock.place[2] == 3;
    EXPECT_NEAR(shock.turn, middle ? 0.75 : shock.opening, 1e-12);  // (1 - cos 120) / 2
  }
}

TEST(ChordTurns, TheGreatestKinkSpeaksForTheWholeTurn) {
  expect_the_middle_to_speak(BoxLattice(5, 5, 9));
}

TEST(ChordTurns, TheBandCrossesSurfacesInsideTheSolid) {
  const BoxLattice box(overlapping_boxes(5, 5, 9));
  ASSERT_GT(box.lattice.axis[2].runs.size(), 25U);
  expect_the_middle_to_speak(box);
}

TEST(ChordTurns, WithoutWidthATurnIsTheOpening) {
  const BoxLattice box(5, 5, 9);
  const FrameField field = layered(box.lattice, {0.9, 0.9, 0.9, 0.5, -0.5, -0.9, -0.9, -0.9, -0.9});
  for (const ChordShock& shock : turned(box, field, unaveraged(0))) EXPECT_EQ(shock.turn, shock.opening);
}

// The band is a share of E / |g|, edges in proportion: with the volume it grows from the shock's own edge (60
// degrees) to three edges (120) and not beyond what turns.
TEST(ChordTurns, TheBandIsAShareOfTheDepth) {
  const BoxLattice box(5, 5, 9);
  const double d = kPi / 180;
  FrameField field =
      layered(box.lattice, {60 * d, 60 * d, 60 * d, 60 * d, 30 * d, -30 * d, -60 * d, -60 * d, -60 * d});
  const auto turn_in_the_middle = [&](double width) {
    for (const ChordShock& shock : turned(box, field, unaveraged(width))) {
      if (shock.place[2] == 4) return std::pair{shock.turn, width * shock.erosion};
    }
    return std::pair{-1.0, 0.0};
  };
  for (const double width : {0.05, 0.1, 0.15, 0.2, 0.3, 0.6}) {
    const auto [turn, edges] = turn_in_the_middle(width);
    EXPECT_NEAR(turn, 0.25 + 0.5 * std::clamp((edges - 1) / 2, 0.0, 1.0), 1e-12) << width;
  }
  for (double& erosion : field.erosion) erosion += 20;
  const auto [turn, edges] = turn_in_the_middle(0.05);
  EXPECT_GT(edges, 1.5);
  EXPECT_NEAR(turn, 0.25 + 0.25 * (edges - 1), 1e-12);
}

// 110 degrees in eleven steps, as round the centre of a ball: nothing speaks, unless one step is wider.
TEST(ChordTurns, EvenTurningIsNoShock) {
  const BoxLattice box(5, 5, 12);
  const double d = kPi / 180;
  std::vector<double> angle;
  for (int k = 0; k < 12; ++k) angle.push_back((55 - 10 * k) * d);
  for (const ChordShock& shock : turned(box, layered(box.lattice, angle), unaveraged(1)))
    EXPECT_EQ(shock.turn, shock.opening);
  for (std::size_t k = 0; k < 6; ++k) angle[k] += 20 * d;
  std::size_t speak = 0;
  for (const ChordShock& shock : turned(box, layered(box.lattice, angle), unaveraged(1))) {
    EXPECT_EQ(shock.turn > shock.opening, shock.place[2] == 5);
    speak += shock.turn > 0.5 ? 1 : 0;
  }
  EXPECT_EQ(speak, 25U);
}

// A gap of one in a sheet of opposite normals: its cells' means raise it, and lower those beside it.
TEST(ChordTurns, AveragingCarriesTheTurnAlongTheSheet) {
  const BoxLattice box(7, 7, 6);
  FrameField field = layered(box.lattice, {1.5, 1.5, 1.5, -1.5, -1.5, -1.5});
  std::vector<ChordShock> shocks = turned(box, field, unaveraged());
  ASSERT_EQ(shocks.size(), 49U);
  const std::vector<ChordShock> even = turned(box, field, {});
  for (std::size_t s = 0; s < 49; ++s) EXPECT_NEAR(even[s].turn, shocks[s].turn, 1e-12);
  // The lower side of the middle column leans: 1.5 -> 0.5 against -1.5.
  for (std::uint32_t p = 0; p < box.lattice.points; ++p) {
    if (p / 6 == 24 && p % 6 < 3) field.gradient[p] = {std::cos(0.5), 0, std::sin(0.5)};
  }
  const std::vector<ChordShock> own = turned(box, field, unaveraged()), mean = turned(box, field, {});
  EXPECT_GT(mean[24].turn, own[24].turn + 0.05);
  EXPECT_LT(mean[23].turn, own[23].turn - 0.005);
  EXPECT_NEAR(mean[0].turn, own[0].turn, 1e-12);
}

// What jumps much less than its neighbours keeps its own opening.
TEST(ChordTurns, ASmallJumpBesideALargeOneDoesNotSpeak) {
  const BoxLattice box(9, 5, 9);
  FrameField field = layered(box.lattice, {0.9, 0.9, 0.9, 0.5, -0.5, -0.9, -0.9, -0.9, -0.9});
  for (std::uint32_t p = 0; p < box.lattice.points; ++p) {
    if (p / 45 >= 5) continue;  // i < 5: the same normals, areas ten times as large
    field.gradient[p] = 10 * field.gradient[p];
    field.erosion[p] *= 10;
  }
  for (const ChordShock& shock : turned(box, field, unaveraged())) {
    if (shock.place[2] != 3) continue;
    const bool beside = shock.place[0] >= 5 && shock.place[0] <= 7;
    EXPECT_EQ(shock.turn == shock.opening, beside) << shock.place[0];
  }
}

}  // namespace
}  // namespace affskel::core
