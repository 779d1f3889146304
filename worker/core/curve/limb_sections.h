#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"
#include "core/spatial/box_tree.h"

namespace affskel::core {

/// The ellipse about a place that a section is like, by its polar equation: 1 / r^2 = mean + cosine cos 2a + sine sin 2a,
/// the best in the squares of 1 / r^2: a gap that a few rays leave by, where another limb begins, hardly changes it.
struct LimbEllipse {
  double mean = 0, cosine = 0, sine = 0;

  /// Of a disc as large.
  double radius() const;
};

/// The section of a limb, as seen from a place within.
struct LimbSection {
  Vec3 centre;        ///< its centroid
  double radius = 0;  ///< of a disc as large
};

/// Sections of a solid by planes, each as far as rays from a place within reach it: what another limb adds in the same
/// plane is not seen.  A ray is at most kWidest times as long as the middle one, so that a plane that runs along a
/// neighbour has no part of it.  Exact for discs, ellipses and boxes about their centres, but for the number of rays.
/// Keeps a reference to the mesh.  Immutable after construction.
class LimbSections {
 public:
  static constexpr double kWidest = 2;
  static constexpr double kSeen = 4;  ///< balls: how far rays reach

  /// On up to `threads` threads.  @param surface closed.
  explicit LimbSections(const Mesh& surface, unsigned threads = 1);

  /// @param place within the solid.
  /// @param across unit normal of the plane.
  /// @param ball about the place, about as large as the limb is thick, > 0.
  LimbSection at(const Vec3& place, const Vec3& across, double ball) const;

  /// The area of all that the plane through a place has of the solid round it, in whatever shape; what lies apart, as another
  /// limb, or within, as a cavity, does not count.  0 from outside.
  /// @param ball about as large as the limb is thick: what is near is looked at first.
  double area(const Vec3& place, const Vec3& across, double ball) const;

  /// @param u, v of the plane, unit vectors at right angles.
  /// @return of which no radius is more than kFlattest times another.
  LimbEllipse ellipse(const Vec3& place, const Vec3& u, const Vec3& v, double ball) const;

  static constexpr double kFlattest = 3;

  /// How thick the solid is about a place: what a share of the rays in three planes at right angles falls short of.  In a
  /// tube its radius, in a plate half its thickness; spikes and dents of noise, which the distance to the surface follows,
  /// change it little.
  double thickness(const Vec3& place, double ball) const;

  /// Where the surface is between two places: the middle of all that; none where they see each other.
  std::optional<Vec3> parted(const Vec3& a, const Vec3& b) const;

 private:
  static constexpr std::size_t kRays = 32;
  using Rays = std::array<double, kRays>;
  using Turn = std::array<double, 2>;  // in the plane, along u and v

  template <class Visit>
  void cut(const Box& round, const Vec3& place, const Vec3& across, const Visit& visit) const;
  double least_outline(const Box& round, const Vec3& place, const Vec3& across) const;
  double height_above(std::size_t ray, const Turn& p) const;  // on its left
  std::uint32_t rays_left_of(const Turn& p) const;            // a bit each: those that have it on their right
  double shortest_rays(const Vec3& place, double reach) const;
  Rays outline(const Vec3& place, const Vec3& u, const Vec3& v, double reach) const;

  const Mesh& surface_;
  BoxTree tree_;
  std::array<Turn, kRays> turns_;  // cosine and sine of each ray's angle
};

}  // namespace affskel::core
