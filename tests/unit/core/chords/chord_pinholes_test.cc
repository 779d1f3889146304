#include "core/chords/chord_pinholes.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/chords/chord_fields.h"

namespace affskel::core {
namespace {

// The plane z = 3.8 of a cube of 9 x 9 x 9 points, 81 shocks.
class Plane {
 public:
  Plane() : shocks_(chord_shocks(box_.lattice, field_)) {}

  void drop(std::uint32_t i, std::uint32_t j) {
    std::erase_if(shocks_, [&](const ChordShock& s) { return s.place[0] == i && s.place[1] == j; });
  }

  std::vector<ChordShock> missing() const {
    return pinhole_shocks(box_.lattice, SolidParts(box_.solid, box_.lattice), field_, shocks_);
  }

  BoxLattice box_{9, 9, 9};
  FrameField field_ =
      field_of_branches(box_.lattice, {linear_branch(1, {0, 0, 1}), linear_branch(8.6, {0, 0, -1})});
  std::vector<ChordShock> shocks_;
};

TEST(Pinholes, AWholeSheetHasNone) {
  EXPECT_TRUE(Plane().missing().empty());
}

TEST(Pinholes, OneMissingShockIsPutBack) {
  Plane plane;
  plane.drop(4, 5);
  const std::vector<ChordShock> missing = plane.missing();
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing[0].place, (std::array<std::uint32_t, 3>{4, 5, 3}));
  EXPECT_EQ(missing[0].axis, 2);
  EXPECT_NEAR(missing[0].position.z, 3.8, 1e-12);
  EXPECT_NEAR(missing[0].erosion, 4.8, 1e-12);
}

// A slit has ends, with three of four sides closed, and so has a notch in the rim.
TEST(Pinholes, SlitsAndNotchesCloseFromTheirEnds) {
  Plane plane;
  for (std::uint32_t j = 3; j < 7; ++j) plane.drop(4, j);
  plane.drop(0, 2);
  const std::vector<ChordShock> missing = plane.missing();
  ASSERT_EQ(missing.size(), 3U);
  EXPECT_EQ(missing[0].place, (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_EQ(missing[1].place, (std::array<std::uint32_t, 3>{4, 3, 3}));
  EXPECT_EQ(missing[2].place, (std::array<std::uint32_t, 3>{4, 6, 3}));
}

TEST(Pinholes, WiderHolesAndTheRimStayOpen) {
  Plane plane;
  for (std::uint32_t i : {4U, 5U}) {
    for (std::uint32_t j : {5U, 6U}) plane.drop(i, j);
  }
  for (std::uint32_t j : {2U, 3U}) plane.drop(0, j);
  EXPECT_TRUE(plane.missing().empty());
}

TEST(Pinholes, NoShockBetweenPointsOfOneDirection) {
  Plane plane;
  plane.drop(4, 5);
  plane.field_.direction[(4 * 9 + 5) * 9 + 4] = 0;
  EXPECT_TRUE(plane.missing().empty());
}

// Where the tangents do not cross there is no strength, and the shock lies in the middle of its edge.
TEST(Pinholes, WithoutACrossingItLiesInTheMiddle) {
  Plane plane;
  plane.drop(4, 5);
  plane.field_.gradient[(4 * 9 + 5) * 9 + 4] = {0, 0, 2};
  const std::vector<ChordShock> missing = plane.missing();
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_EQ(missing[0].t, 0.5);
  EXPECT_EQ(missing[0].strength, 0);
}

}  // namespace
}  // namespace affskel::core
