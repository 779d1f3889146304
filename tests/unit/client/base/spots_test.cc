#include "client/base/spots.h"

#include <gtest/gtest.h>

#include "core/base/vec3.h"

namespace affskel::client {
namespace {

std::uint32_t add_vertex(v1::TriangleMesh& sheet, const core::Vec3& at) {
  for (const double c : {at.x, at.y, at.z}) sheet.add_xyz(c);
  return static_cast<std::uint32_t>(sheet.xyz_size() / 3 - 1);
}

TEST(Spots, AreOneOfEachPieceThatIsSmallAlongEachAxis) {
  v1::TriangleMesh sheet;
  const std::uint32_t alone = add_vertex(sheet, {5, 5, 5});
  std::uint32_t in_triangle = 0;
  for (const core::Vec3& at : {core::Vec3{0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0}})
    sheet.add_corners(in_triangle = add_vertex(sheet, at));
  sheet.add_segments(add_vertex(sheet, {9, 0, 0}));  // long along z only
  sheet.add_segments(add_vertex(sheet, {9, 0, 1}));
  const std::vector<std::uint32_t> spots = spots_of(sheet, 0.5);
  ASSERT_EQ(spots.size(), 2u);
  EXPECT_EQ(spots[0], alone);
  EXPECT_TRUE(spots[1] >= 1 && spots[1] <= in_triangle);
  EXPECT_EQ(spots_of(sheet, 0.4).size(), 1u) << "no piece as long as the size";
  EXPECT_EQ(spots_of(sheet, 1.1).size(), 3u);
}

TEST(Spots, OfNothingThereAreNone) {
  EXPECT_TRUE(spots_of({}, 1).empty());
}

}  // namespace
}  // namespace affskel::client
