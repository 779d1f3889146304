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
/// kAffine: F = s C^(1/2) R, C the covariance, s = det(C)^(-1/6), R the rotation to the axes u that maximise
///   sum (E[(u.w)^4] - 3)^2, w = C^(-1/2) (x - centroid) (Comon 1994, see independent_axes), by descending
///   E[(u.w)^4].  For an affine map M of determinant 1 the frame of M V is M F: lattice, field and skeleton
///   go along with the map.  Noise on the vertices of human bodies (0.5 to 1 % of the box diagonal) turns R
///   by a seventh of what it turns the eigenvectors of E[|w|^2 w w^T] (Cardoso 1989), in the median.  Two
///   maxima of nearly the same height may still change places, and the axes then jump.
///
/// Signs, for all but kAxis: third moments along the first two axes are > 0, and the third axis makes them
/// right-handed.  For kAffine they are > 0 along all three (so that noise on the order of two axes of about
/// the same E[(u.w)^4], as mirror-symmetric solids have them, does not show): if that is left-handed, the two
/// axes that differ the least in E[(u.w)^4] change places.  An axis whose third moment vanishes (below 1e-6
/// of that of its length) points to where its largest component is > 0, or for kAffine, if it is the last
/// such one, to where it makes the axes right-handed.  Order and signs map the lattice onto itself.
///
/// What differs by less than 1e-6 of the largest counts as equal.  Equal sides or E[(u.w)^4]: the axis nearer
/// to x first, then the one nearer to y.  Equal eigenvalues of the covariance (kPca): a solid of that much
/// symmetry does not determine the axes.  Two equal ones: the first of their axes is the projection onto
/// their plane of the coordinate axis nearest to it; three: the coordinate axes.  kAffine where the maximum
/// is not unique: independent_axes says which one is taken, by the coordinate axes of w (a box, a ball and an
/// ellipsoid with axes parallel to the mesh's have F = s C^(1/2)).  This choice is reproducible, but for
/// kAffine it does not go along with M: the frame of M V is M F times a rotation which leaves the contrast
/// as it is, at least to 1e-6.
///
/// A function of the mesh alone, and all machines agree on every bit (kObb: see least_box_axes).
/// @throws CoreError kBadInput when the solid is so flat that its covariance is singular to rounding
/// (kAffine).
Matrix3 solid_frame(const Solid& solid, FrameKind kind);

}  // namespace affskel::core
