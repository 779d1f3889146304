#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/box.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Parts a solid where its limbs meet.  Each limb is a tube about its line, with a joint as thick as it is where it
/// leaves it (kJoint balls away): the largest ball about a joint is wider than any of its limbs.  What lies there
/// in the tube of a limb that is thicker, all in all, belongs to that; what lies in one tube alone to its limb;
/// what lies in none, as at the sides of a chest, to the limb in whose tube the line that it is nearest to is.  So
/// an arm begins where it leaves the trunk, equal limbs share their joint evenly, and a joint itself has nothing.
/// A link within the tube of a longer limb, whole, has nothing either.  Keeps references to its arguments.
class LimbTubes {
 public:
  /// @param places, ball, radius per vertex: distance to the surface, and of a disc as large as the section.  A limb is as
  ///   thick as that disc, but no more than kRoundest balls: what hangs on a plate begins on its face.
  /// @param segments as for polylines().
  LimbTubes(std::span<const Vec3> places, std::span<const Segment> segments, std::span<const double> ball,
            std::span<const double> radius);

  /// The vertex that a place belongs to.
  /// @param nearest the vertex of the lines that it is nearest to.
  std::uint32_t vertex_of(const Vec3& at, std::uint32_t nearest) const;

  static constexpr double kJoint = 1.5;  ///< balls; see centre_lines()
  static constexpr double kRoundest = 1.1;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Limb {
    std::vector<std::uint32_t> vertices;
    std::vector<double> tube = {};  // per vertex: its radius
    double size = 0;                // how thick it is in the middle of its vertices
    std::array<std::vector<std::uint32_t>, 2> thicker = {},
                                              others = {};  // that meet it there, the thickest first
    Box box = {};                                           // round the tube
    std::uint32_t within = kNone;                           // the limb that it is a part of

    std::uint32_t end(std::size_t which) const { return which == 0 ? vertices.front() : vertices.back(); }
  };

  double thickness_of(std::uint32_t vertex) const;
  bool is_joint(std::uint32_t vertex) const { return !at_joint_[vertex].empty(); }
  void measure(Limb& limb) const;
  void compare(Limb& limb, std::size_t end) const;
  void find_within(Limb& limb) const;
  bool holds(const Limb& limb, const Vec3& at) const;
  std::uint32_t holder(const std::array<std::vector<std::uint32_t>, 2>& limbs, const Vec3& at) const;
  std::uint32_t nearest_of(std::span<const std::uint32_t> vertices, const Vec3& at,
                           std::uint32_t before) const;
  std::uint32_t off_joint(std::uint32_t vertex, const Vec3& at) const;

  std::span<const Vec3> places_;
  std::span<const double> ball_, radius_;
  std::vector<Limb> limbs_;
  std::vector<std::uint32_t> limb_of_;                // per vertex that is no joint
  std::vector<std::uint32_t> in_thicker_;             // per vertex: the thicker limb in whose tube it is
  std::vector<std::vector<std::uint32_t>> at_joint_;  // per joint: its limbs, one that comes back to it twice
};

}  // namespace affskel::core
