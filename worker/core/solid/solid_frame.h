#pragma once

#include <string_view>

#include "core/base/matrix3.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// The coordinates in which the lattice is parallel to the axes.
enum class FrameKind {
  kAxis,    ///< those of the mesh
  kPca,     ///< the principal axes of the solid, the longest first
  kObb,     ///< the axes of its bounding box of least volume, the longest first
  kAffine,  ///< the solid's second moments made equal, volumes kept
};

/// "axis", "pca", "obb" or "affine".
/// @throws CoreError kBadInput.
FrameKind parse_frame(std::string_view name);

/// The frame's matrix F: a place with the coordinates u in the frame is x = centre + F u in the mesh, and
/// det F = 1, so that volumes are the same in both.  Lengths in the frame are mesh lengths for all kinds but
/// kAffine, whose unit is what a mesh unit becomes on the (geometric) mean of the axes.
///
/// kAxis: exactly the identity.
/// kPca: the eigenvectors of the covariance, by descending eigenvalue.
/// kObb: the axes of the vertices' bounding box of least volume (see least_box_axes), the longest side first.
/// kAffine: F = s C^(1/2) R, C the covariance, s = det(C)^(-1/6), R the rotation to the independent axes of
///   C^(-1/2) (x - centroid) (Comon 1994, see independent_axes), by descending kurtosis.  For an affine map M
///   of determinant 1 the frame of M V is M F, unless the solid's symmetry leaves the axes open.
///
/// Signs, ties and what symmetric solids get: solid_frame.cc.  A function of the mesh alone; all machines
/// agree on every bit (kObb: see least_box_axes).
/// @param context asked whether to stop; may be null.
/// @throws CoreError kBadInput when the solid is so flat that its covariance is singular to rounding
///   (kAffine); kCancelled when the context asks to stop.
Matrix3 solid_frame(const Solid& solid, FrameKind kind, ExecutionContext* context = nullptr);

}  // namespace affskel::core
