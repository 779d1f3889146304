#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/curve/limb_forks.h"
#include "core/curve/limb_hubs.h"
#include "core/curve/limb_sections.h"
#include "core/mesh/box.h"

namespace affskel::core {

/// Of limbs that are about as thick neither is a part of the other; a section that is larger than most is open.
inline constexpr double kClearlyThicker = 1.1;

/// The section of a tube at a vertex.
struct TubeRing {
  Vec3 u, v;  ///< of the section's plane
  LimbEllipse ellipse;
  double thickness = 0;  ///< along the tube

  /// Of a way from the middle; 1 on its ellipse.
  double across(const Vec3& way) const;
};

/// A limb as a tube about its line.
struct TubedLimb {
  std::vector<std::uint32_t> vertices;  ///< none where all lies in a hub
  std::array<std::uint32_t, 2> ends;    ///< a hub's joint where a hub has what lies before
  std::vector<TubeRing> rings = {};     ///< per vertex; none of a line by itself
  double size = 0;                      ///< how thick it is in the middle of its vertices
  Box box = {};                         ///< round the tube

  std::size_t index(std::size_t end, std::size_t n) const { return end == 0 ? n : vertices.size() - 1 - n; }
  std::uint32_t at(std::size_t end, std::size_t n) const { return vertices[index(end, n)]; }
};

struct TubedLimbs {
  std::vector<TubedLimb> limbs;
  LimbHubs hubs;                             ///< with what of lines between them no limb has
  std::vector<std::uint32_t> limb_of, rank;  ///< per vertex that is no joint: its limb, and its place there
  std::vector<char> is_shared;               ///< per vertex: near a joint
  std::vector<std::vector<std::uint32_t>> at_joint;  ///< per joint: its limbs, one that comes back twice

  bool is_joint(std::uint32_t vertex) const { return !at_joint[vertex].empty(); }
};

struct TubedLimbsInput {
  /// See LimbSections::ellipse().
  using EllipseAt = std::function<LimbEllipse(const Vec3& place, const Vec3& u, const Vec3& v, double ball)>;

  std::span<const Vec3> places;                       ///< per vertex
  std::span<const std::vector<std::uint32_t>> lines;  ///< see polylines()
  std::span<const double> ball;                       ///< per vertex: see LimbSections::thickness()
  /// Per vertex: see slice_radii(). By those a limb is as thick as it is, however large the balls are where it lies
  /// in another.
  std::span<const double> radius;
  std::span<const std::vector<LimbFork>> forks;  ///< per vertex: see limb_forks(), of the same lines
  LimbHubs hubs;                                 ///< see limb_hubs(), of the same lines
  EllipseAt ellipse_at;
};

/// The tubes of limbs, whose sections are ellipses like the limbs' own. Towards a joint, where sections open into
/// other limbs, a tube goes on with the one that it has where it leaves the joint (JointBalls::kNear of its sizes
/// away, and no larger than it mostly is), and ends in half an ellipsoid, no farther than where the limbs beyond part
/// from each other.
TubedLimbs tubed_limbs(const TubedLimbsInput& input);

}  // namespace affskel::core
