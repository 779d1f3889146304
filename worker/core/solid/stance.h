#pragma once

#include <cstddef>
#include <optional>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// One of the six directions along the axes.
struct AxisDirection {
  std::size_t axis = 0;  ///< 0 .. 2: x, y, z
  bool minus = false;

  Vec3 vector() const;  ///< of length 1
  friend bool operator==(const AxisDirection&, const AxisDirection&) = default;
};

/// How a solid stands.
struct Stance {
  AxisDirection up{2, false};
  AxisDirection front{1, true};  ///< where its front looks, to the viewer; another axis than `up`

  Vec3 right() const;  ///< to the right of a viewer of its front: right, up, front are right-handed
  friend bool operator==(const Stance&, const Stance&) = default;
};

/// How a solid stands, as its shape tells.  No theorem, but what bodies, animals and busts have in common:
/// - what a quarter turn about z or y maps to itself stands on that axis, as bowls and gears do; flat parts lie on z or,
///   if thin along another axis, stand and face along it, as letters do that are read so.  Of all others:
/// - left and right are mirror images, so that the axis across is neither up nor in front;
/// - up is z or y, whichever it stands on better: its lowest twentieth lies on both sides of the middle and is spread
///   more widely; where neither is better, y if it is 1.25 times as long as the others;
/// - the front is where the head is, if it lies well off the middle (an animal's), else where the feet point.
/// What the shape does not tell is usual: z up and -y in front, with y up +z, with x up +z.
/// Depends on the surface alone, not on its triangles or their sense, but for rounding.
/// @param up where it is known.
/// @param mesh of one point or more.  Without area, or with coordinates that overflow: the usual.
Stance find_stance(const Mesh& mesh, std::optional<AxisDirection> up = {});

}  // namespace affskel::core
