#include "client/render/arrangement.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

double width_of(const Block& block, double scale) {
  return scale * block.width + block.fixed_width;
}
double height_of(const Block& block, double scale) {
  return scale * block.height + block.fixed_height;
}

// No two blocks overlap, and none leaves the room.
void expect_apart(const std::vector<Block>& blocks, const Arrangement& a, double width) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_GE(a.places[i].left, -1e-9);
    EXPECT_GE(a.places[i].top, -1e-9);
    EXPECT_LE(a.places[i].left + width_of(blocks[i], a.scale), width + 1e-6);
    EXPECT_LE(a.places[i].top + height_of(blocks[i], a.scale), a.height + 1e-6);
    for (std::size_t j = 0; j < i; ++j) {
      const bool beside = a.places[j].left + width_of(blocks[j], a.scale) <= a.places[i].left + 1e-6 ||
                          a.places[i].left + width_of(blocks[i], a.scale) <= a.places[j].left + 1e-6;
      const bool below = a.places[j].top + height_of(blocks[j], a.scale) <= a.places[i].top + 1e-6 ||
                         a.places[i].top + height_of(blocks[i], a.scale) <= a.places[j].top + 1e-6;
      EXPECT_TRUE(beside || below) << i << " and " << j;
    }
  }
}

TEST(Arrangement, OneBlockFillsTheRoom) {
  const std::vector<Block> blocks = {{2, 1, 0, 0}};
  const Arrangement a = arrange(blocks, 100, 1000, 5);
  EXPECT_NEAR(a.scale, 50, 1e-6);
  EXPECT_NEAR(a.height, 50, 1e-6);
}

TEST(Arrangement, AFlatBlockGoesUnderAWideOne) {
  // From the front, from above and from the side of a plate that stands: side by side a third stayed empty.
  const std::vector<Block> blocks = {{18, 18, 0, 0}, {4, 18, 0, 0}, {18, 4, 0, 0}};
  const Arrangement a = arrange(blocks, 220, 1000, 0);
  expect_apart(blocks, a, 220);
  EXPECT_NEAR(a.scale, 10, 1e-6);
  EXPECT_NEAR(a.places[0].left, a.places[2].left, 1e-6);
  EXPECT_GT(a.places[2].top, a.places[0].top);
}

TEST(Arrangement, TextTakesTheRoomThatIsLeft) {
  // A standing body, and a legend of 40 x 60 pixels.
  const std::vector<Block> blocks = {{6, 17, 4, 10}, {3, 17, 4, 10}, {6, 3, 4, 10}, {0, 0, 40, 60}};
  const Arrangement a = arrange(blocks, 300, 380, 6);
  expect_apart(blocks, a, 300);
  EXPECT_LT(a.places[2].left, a.places[3].left + 40) << "the legend is under the view from above";
  EXPECT_GT(a.places[3].top, a.places[2].top);
}

TEST(Arrangement, TheScaleIsTheLargestThatFits) {
  const std::vector<Block> blocks = {{6, 17, 4, 10}, {3, 17, 4, 10}};
  const Arrangement a = arrange(blocks, 300, 180, 6);
  EXPECT_NEAR(a.scale, 10, 1e-6) << "17 s + 10 = 180";
}

}  // namespace
}  // namespace affskel::client
