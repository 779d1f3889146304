#pragma once

#include <array>

#include "core/base/matrix3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

// Integrals over the solid that a closed, outward-oriented mesh bounds, cavities left out (where a mesh
// crosses itself: weighted by its winding number).  E[.] is the mean over the solid, coordinates and units
// are the mesh's.  All are exact up to rounding: the solid is the sum of the signed tetrahedra between
// its triangles and one point, whose moments are polynomials in the corners (Lasserre & Avrachenkov 2001);
// the sums are compensated, and use +, -, *, / and sqrt only.

struct Moments {
  double volume = 0;
  Vec3 centroid;         ///< c = E[x]
  Matrix3 covariance{};  ///< E[(x - c) (x - c)^T]
};

/// @param mesh closed, of volume > 0.
Moments solid_moments(const Mesh& mesh);

/// E[(axis . (x - centre))^3]; `volume` as found by solid_moments.
double third_moment(const Mesh& mesh, double volume, const Vec3& centre, const Vec3& axis);

/// m[i][j][k][l] = E[w_i w_j w_k w_l]: the same for every order of the indices.
using FourthMoments = std::array<std::array<Matrix3, 3>, 3>;

/// Those of w = map (x - centre); `volume` as found by solid_moments.
FourthMoments fourth_moments(const Mesh& mesh, double volume, const Vec3& centre, const Matrix3& map);

}  // namespace affskel::core
