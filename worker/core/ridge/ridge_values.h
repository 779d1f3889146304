#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/matrix3.h"
#include "core/base/vec3.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"
#include "core/ridge/smoothed_derivatives.h"

namespace affskel::core {

constexpr double kMaxRidgeStrength = 1000;  ///< where the gradient vanishes, s has no bound

/// The Hessian of P at a sample point, lambda_1 <= lambda_2 <= lambda_3; all 0 where it cannot give a ridge.
struct PointRidge {
  std::array<float, 3> across{};  ///< e_1, the eigenvector of lambda_1, unit, of either sign
  std::array<float, 3> along{};   ///< e_3, that of lambda_3, likewise
  float least = 0;                ///< lambda_1, per spacing squared; < 0 on a ridge
  float ratio = 0;                ///< lambda_2 / lambda_1
  float roundness = 0;            ///< lambda_3 / lambda_1
};

/// What is known of ridges at the sample points, and between them by linear interpolation.  Keeps references
/// to all but the ridges.
class RidgeValues {
 public:
  /// @param derivatives of this field.
  /// @param min_strength least s that is asked for, radians: points far below it are left out.
  /// @param min_erosion least E that is asked for, as a share of the volume of the sample points' cells in
  /// the
  ///   part, 0 .. 1.
  /// @throws CoreError kBadInput when a bound is out of range.
  RidgeValues(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
              std::span<const PointDerivatives> derivatives, double min_strength, double min_erosion);

  const PointRidge& ridge(std::uint32_t point) const { return ridges_[point]; }

  /// grad P, per spacing.
  Vec3 gradient(std::uint32_t point) const;

  /// Whether the two bounds hold for a strength and the vertex's E.
  bool counts(double strength, const SheetVertex& vertex) const {
    return strength >= min_strength_ && vertex.erosion >= least_erosion_[parts_.of_point(vertex.point)];
  }

  /// The vertex at `position` that has the weighted mean of the points' values; its `strength` is that of the
  /// surface.
  /// @param points the first one becomes the vertex's sample point.
  /// @param weights one per point, >= 0, with the sum 1.
  /// @param across e_1 there, unit, of either sign.
  SheetVertex at(const Vec3& position, std::span<const std::uint32_t> points, std::span<const double> weights,
                 const Vec3& across) const;

  /// |grad_u E|: the section's area as the frame measures it (SheetVertex::area is that of the mesh).
  double frame_area(std::uint32_t point) const;

 private:
  const SolidParts& parts_;
  const FrameField& field_;
  std::span<const PointDerivatives> derivatives_;
  double min_strength_;
  Matrix3 to_mesh_;                    // F^-T
  std::vector<double> least_erosion_;  // per part
  std::vector<PointRidge> ridges_;     // per sample point
};

/// The entries of PointRidge and PointDerivatives as vectors.
inline Vec3 vector_of(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

}  // namespace affskel::core
