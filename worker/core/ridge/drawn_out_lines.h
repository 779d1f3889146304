#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/edges.h"

namespace affskel::core {

struct LinesToDrawOut {
  const std::vector<Vec3>& places;           ///< per vertex of the skeleton, in the solid
  const Adjacency& neighbours;               ///< per vertex, along lines and surfaces
  double step = 0;                           ///< in which it is looked how deep a place lies
  std::function<double(const Vec3&)> depth;  ///< of a place below the surface of the solid; 0 outside
};

struct MovedVertex {
  std::uint32_t vertex = 0;
  Vec3 place;
};

/// Draws the lines of a skeleton out to the tips that they lead to.  A line ends in the middle of a round end, as far from the
/// tip as the limb is thick.  Its last stretch, as long as that, goes on straight, drawn out evenly, until it is half as
/// deep: nearer to the surface lines would follow its noise.  None becomes longer by more than it was deep; one that is shorter
/// than that stays, and so does one that bends so much that it would come nearer to the surface.
/// @return what moves, by number.
std::vector<MovedVertex> drawn_out_lines(const LinesToDrawOut& lines);

}  // namespace affskel::core
