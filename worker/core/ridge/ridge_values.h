#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/matrix3.h"
#include "core/base/vec3.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/ridge/smoothed_derivatives.h"
#include "core/spatial/distance_to_mesh.h"

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
  /// @param radius per sample point: see surface_distance().
  /// @param surface of the solid, lattice coordinates.
  /// @param smoothed where noise makes the surface cross itself, the same without it: what is deep below either is deep.
  /// @param min_strength least s that is asked for, radians: points far below it are left out.
  /// @param threads >= 1; what is known does not depend on it.
  /// @throws CoreError kBadInput when the strength is out of range.
  RidgeValues(const Lattice& lattice, const FrameField& field, std::span<const PointDerivatives> derivatives,
              std::span<const float> radius, const DistanceToMesh& surface, const DistanceToMesh* smoothed,
              double min_strength, unsigned threads = 1);

  const PointRidge& ridge(std::uint32_t point) const {
    static constexpr PointRidge kNoRidge;
    const Group& group = groups_[point / 32];
    const std::uint32_t bit = 1U << point % 32;
    if ((group.has & bit) == 0) return kNoRidge;
    const auto before = static_cast<std::uint32_t>(std::popcount(group.has & (bit - 1)));
    return ridges_[point / kTogether][group.before + before];
  }

  /// grad P, per spacing.
  Vec3 gradient(std::uint32_t point) const;

  /// What a strength is that of.
  enum class Of { kSurface, kCurve };

  /// Whether a vertex has the least strength that is asked for.
  bool is_strong(const SheetVertex& vertex) const { return vertex.strength >= min_strength_; }
  /// Whether it is far enough from the surface.  Takes a search.
  bool is_deep(const SheetVertex& vertex) const;
  bool counts(const SheetVertex& vertex) const { return is_strong(vertex) && is_deep(vertex); }

  /// The vertex at `position` that has the weighted mean of the points' values.
  /// @param points the heaviest one, of equal ones the first, becomes the vertex's sample point.
  /// @param weights one per point, >= 0, with the sum 1.
  /// @param across e_1 there, unit, of either sign.
  SheetVertex at(Of of, const Vec3& position, std::span<const std::uint32_t> points,
                 std::span<const double> weights, const Vec3& across) const;

 private:
  double least_radius(const SheetVertex& vertex) const;
  bool is_deep(const SheetVertex& vertex, const DistanceToMesh& surface) const;

  const FrameField& field_;
  std::span<const PointDerivatives> derivatives_;
  std::span<const float> radius_;
  const DistanceToMesh& surface_;
  const DistanceToMesh* smoothed_;
  double widest_;  // no ball in the solid is larger, spacings
  double min_strength_;
  Matrix3 to_mesh_;                                 // F^-T
  static constexpr std::uint32_t kTogether = 4096;  // points whose ridges are found on one thread
  // Of 32 points: which have a ridge, and how many before them, of those found together, have.
  struct Group {
    std::uint32_t has = 0, before = 0;
  };
  std::vector<Group> groups_;
  std::vector<std::vector<PointRidge>> ridges_;  // of points that have one, as they were found
};

}  // namespace affskel::core
