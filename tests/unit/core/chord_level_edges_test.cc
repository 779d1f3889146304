#include "core/chord_level_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "chord_fields.h"
#include "core/betti_numbers.h"
#include "core/chord_sheet.h"
#include "core/error.h"
#include "core/sheet_topology.h"
#include "core/split_mix64.h"

namespace affskel::core {
namespace {

// The plane z = 4 of a cube of 9 x 9 x 9 points passes through a layer of them.  Each of these has two equal
// chords; `upper` says which of them hold to the one above.
class LayerOfTies {
 public:
  explicit LayerOfTies(const std::function<bool(std::uint32_t, std::uint32_t)>& upper) {
    for (std::uint32_t i = 0; i < 9; ++i) {
      for (std::uint32_t j = 0; j < 9; ++j) {
        const std::uint32_t p = (i * 9 + j) * 9 + 4;
        field_.direction[p] = upper(i, j) ? 1 : 0;
        field_.gradient[p] = {0, 0, upper(i, j) ? -1.0 : 1.0};
      }
    }
  }

  std::vector<ChordShock> added() const {
    const std::vector<ChordShock> before = chord_shocks(box_.lattice, field_);
    std::vector<ChordShock> after = before, added;
    add_level_edges(box_.lattice, SolidParts(box_.solid, box_.lattice), field_, after);
    for (const ChordShock& shock : after) {
      const bool old = std::any_of(before.begin(), before.end(), [&](const ChordShock& s) {
        return s.point == shock.point && s.axis == shock.axis;
      });
      if (!old) added.push_back(shock);
    }
    EXPECT_EQ(after.size(), before.size() + added.size());
    return added;
  }

  ChordSheet sheet() const { return chord_sheet(box_.solid, box_.lattice, field_); }

 private:
  BoxLattice box_{9, 9, 9};
  FrameField field_ =
      field_of_branches(box_.lattice, {linear_branch(1, {0, 0, 1}), linear_branch(9, {0, 0, -1})});
};

TEST(LevelEdges, ThereAreNoneWhereAllHoldToOneSide) {
  EXPECT_TRUE(LayerOfTies([](auto, auto) { return true; }).added().empty());
  EXPECT_TRUE(LayerOfTies([](auto, auto) { return false; }).added().empty());
}

TEST(LevelEdges, LieInTheSheetWhereNeighboursDiffer) {
  const std::vector<ChordShock> added =
      LayerOfTies([](std::uint32_t i, std::uint32_t) { return i > 3; }).added();
  ASSERT_EQ(added.size(), 9U);
  for (std::uint32_t j = 0; j < 9; ++j) {
    EXPECT_EQ(added[j].axis, 0);
    EXPECT_EQ(added[j].place, (std::array<std::uint32_t, 3>{3, j, 4}));
    EXPECT_EQ(norm(added[j].position - Vec3{3.5, 1.0 * j, 4}), 0);
    EXPECT_EQ(added[j].erosion, 5);
    EXPECT_EQ(added[j].turn, 1);
    EXPECT_EQ(added[j].strength, 1);
  }
}

// Whatever chance decides, the sheet is one disc in the plane.
TEST(LevelEdges, HoldASheetOfTiesTogether) {
  SplitMix64 random(7);
  for (int round = 0; round < 20; ++round) {
    std::vector<bool> upper;
    for (int k = 0; k < 81; ++k) upper.push_back(random.next() % 2 == 0);
    const ChordSheet sheet =
        LayerOfTies([&](std::uint32_t i, std::uint32_t j) { return upper[i * 9 + j]; }).sheet();
    Mesh mesh;
    for (const ChordSheetVertex& v : sheet.vertices) {
      EXPECT_NEAR(v.position.z, 4, 0.1);
      mesh.points.push_back(v.position);
    }
    mesh.triangles = sheet.triangles;
    EXPECT_EQ(sheet_topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  }
}

TEST(LevelEdges, RefuseShareOutOfRange) {
  const BoxLattice box(3, 3, 3);
  const FrameField field = field_of_branches(box.lattice, {linear_branch(1, {0, 0, 1})});
  std::vector<ChordShock> none;
  const SolidParts parts(box.solid, box.lattice);
  EXPECT_THROW(add_level_edges(box.lattice, parts, field, none, {1.5, 0.1}), CoreError);
  EXPECT_THROW(add_level_edges(box.lattice, parts, field, none, {0.5, -0.1}), CoreError);
}

}  // namespace
}  // namespace affskel::core
