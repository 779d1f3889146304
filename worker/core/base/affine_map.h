#pragma once

#include <array>

#include "core/base/vec3.h"

namespace affskel::core {

/// x -> M x + shift.  The identity unless set.  Only + - * / and sqrt are used here, so that all machines
/// agree on every bit.
struct AffineMap {
  std::array<Vec3, 3> rows = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< of M
  Vec3 shift = {};

  Vec3 operator()(const Vec3& point) const {
    return Vec3{dot(rows[0], point), dot(rows[1], point), dot(rows[2], point)} + shift;
  }
};

AffineMap scaling(double x, double y, double z);
AffineMap translation(const Vec3& shift);
/// Counter-clockwise seen from the tip of the axis (0, 1, 2); exact at multiples of 90 degrees.
AffineMap rotation(int axis, double degrees);
/// Coordinate `to` += factor * coordinate `from`; to != from.
AffineMap shear(int to, int from, double factor);

/// First `first`, then `second`.
AffineMap then(const AffineMap& first, const AffineMap& second);

/// det M: volumes grow by its magnitude; < 0 for a reflection.
double determinant(const AffineMap& map);

/// Whether M has no usable inverse: a number of the map is not finite, or |det M| < 1e-12 times the product
/// of the lengths of M's rows.
bool is_singular(const AffineMap& map);

/// @throws CoreError kBadInput when the map is singular.
void require_regular(const AffineMap& map);

/// @throws CoreError kBadInput when the map is singular.
AffineMap inverse(const AffineMap& map);

/// Maps normals of planes: a plane with the normal n becomes one with the normal M^-T n / |M^-T n|, and the
/// side it points to stays the same side, also under a reflection.
class NormalMap {
 public:
  /// @throws CoreError kBadInput when the map is singular.
  explicit NormalMap(const AffineMap& map);

  /// The normal of the image; (0, 0, 0) stays so.  Exactly n when M is the identity.
  Vec3 operator()(const Vec3& n) const;

 private:
  std::array<Vec3, 3> cofactors_;  // the rows of det M * M^-T
  bool turned_ = false;            // det M < 0
  bool identity_ = false;          // of M
};

}  // namespace affskel::core
