#pragma once

#include "core/mesh/mesh.h"

namespace affskel::client {

/// The axis that points up in pictures and on pages.
enum class UpAxis { kX, kY, kZ };

/// Which way is up, unless the user says it; pictures and pages ask here.  z, as in this project's bodies,
/// but y where the shape says so:
/// - it stands along y: its box is 1.25 times as long along y as along x and along z;
/// - or it is a figure with its arms spread, drawn in the plane of x and y: its box is less than half as long
///   along z as along both others, its centre of volume lies within 2 % of the box's middle along x, and 3 %
///   of the height or more away from it along y.
/// Nothing speaks for x.
/// @param mesh closed, with a point.
UpAxis up_axis(const core::Mesh& mesh);

/// 'x', 'y' or 'z'.
char up_letter(UpAxis up);

/// How a solid stands, seen from the front: unit vectors, right-handed.
struct Stance {
  core::Vec3 right;  ///< to the right of who looks at its front
  core::Vec3 up;
  core::Vec3 front;  ///< where its front looks, to the viewer
};

/// With z up a body faces -y, with y up +z, with x up +z.
Stance stance(UpAxis up);

}  // namespace affskel::client
