#pragma once

#include <vector>

namespace affskel::client {

/// A rectangle of a picture: a drawing that grows with the scale, and what does not grow round it.
struct Block {
  double width = 0, height = 0;              ///< mesh units; both 0 for a block of text
  double fixed_width = 0, fixed_height = 0;  ///< pixels, added
};

/// Where a block stands, pixels from the upper left corner of the room.
struct BlockPlace {
  double left = 0, top = 0;
};

struct Arrangement {
  double scale = 0;  ///< pixels per mesh unit
  double height = 0;
  std::vector<BlockPlace> places;  ///< per block
};

/// Puts blocks side by side and under each other, all at one scale, so that they fill as much of the picture
/// as they can: of all ways to share the blocks out among columns, the one with the largest share filled.
/// Columns and blocks keep their order; what is left over is spread evenly.
/// @param width, tallest of the room, pixels. @param gap between columns, pixels.
/// @param blocks at most 8, of which one has a size in mesh units.
Arrangement arrange(const std::vector<Block>& blocks, double width, double tallest, double gap);

}  // namespace affskel::client
