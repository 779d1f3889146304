#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::client {

/// A solid in parts, with the lines through them.
struct LimbedSurface {
  core::Mesh surface;
  std::vector<std::uint32_t> triangle_part;          ///< per triangle, from 0
  std::vector<core::Vec3> places;                    ///< of the curve's vertices
  std::vector<std::vector<std::uint32_t>> branches;  ///< per part: its vertices of the curve, one or more
  std::vector<double> radius;                        ///< per part: mean
};

/// A bone begins at its joint and turns with it.
struct Joint {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  core::Vec3 place;
  std::uint32_t parent = kNone;
  std::uint32_t part = 0;
  std::uint32_t number = 0;  ///< along the part, from 0
};

/// What a vertex of the surface follows: two joints and the share of the first, 0.5 .. 1.
struct Binding {
  std::array<std::uint32_t, 2> joint{};
  double share = 1;
};

/// The lines of a curve as a tree of joints, and a surface that follows them.
struct Armature {
  std::vector<Joint> joints;      ///< parents first; a root for each piece of the curve
  std::vector<Binding> bindings;  ///< per vertex of the surface
};

/// Joints stand where branches begin, end and bend: polylines within a quarter of the part's radius (Douglas and Peucker
/// 1973).  Every branch has a joint of its own where it begins, so that it turns by itself.  A loop is cut where it
/// closes.  A vertex follows the nearest bone of the parts that it belongs to, and near a bone's ends the next one, too.
Armature make_armature(const LimbedSurface& solid);

}  // namespace affskel::client
