#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/curve/joint_balls.h"
#include "core/curve/limb_forks.h"
#include "core/curve/limb_hubs.h"
#include "core/curve/limb_sections.h"
#include "core/mesh/box.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Parts a solid where its limbs meet. Each limb is a tube about its line, whose sections are ellipses like the limb's
/// own: a flat chest is a flat tube. Towards a joint, where sections open into other limbs, it goes on with the one
/// that it has where it leaves the joint (JointBalls::kNear of its sizes away, and no larger than it mostly is), and ends in half an
/// ellipsoid, no farther than where the limbs beyond part from each other. What lies there in the tube of a limb that is
/// thicker, all in all, belongs to that, of several about as thick to the one that it lies deepest in; what lies in its own
/// tube to that; else it belongs to the limb whose tube it lies deepest in, or is nearest to. So an arm begins where it leaves the trunk, from the armpit to the top of the shoulder,
/// equal limbs share their joint evenly, and a joint itself has nothing, unless it is a hub (see limb_hubs()): then it
/// is the thickest, and its tube is an ellipsoid. A link or loop whose line lies in the tubes of the
/// others that it meets, whole, has nothing either. Keeps references to its arguments.
class LimbTubes {
 public:
  /// See LimbSections::ellipse().
  using EllipseAt = std::function<LimbEllipse(const Vec3& place, const Vec3& u, const Vec3& v, double reach)>;

  /// @param places, ball, radius per vertex: how thick the solid is there, see LimbSections::thickness(), and see
  ///   slice_radii(). By those a limb is as thick as it is, however large the balls are where it lies in another.
  /// @param segments as for polylines().
  /// @param forks per vertex, see limb_forks(), of the same polylines.
  LimbTubes(std::span<const Vec3> places, std::span<const Segment> segments, std::span<const double> ball,
            std::span<const double> radius, std::span<const std::vector<LimbFork>> forks, LimbHubs hubs,
            const EllipseAt& ellipse_at);

  /// The vertex that a place belongs to.
  /// @param nearest the vertex of the lines that it is nearest to.
  std::uint32_t vertex_of(const Vec3& at, std::uint32_t nearest) const;

  static constexpr double kRoundest = 1.1;

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Ring {
    Vec3 u, v;  // of the section's plane
    LimbEllipse ellipse;
    double thickness = 0;
  };
  struct Limb {
    std::vector<std::uint32_t> vertices;  // none where all lies in a hub
    std::array<std::uint32_t, 2> ends;    // a hub's joint where a hub has what lies before
    std::vector<Ring> rings = {};         // per vertex; none of a line by itself
    double size = 0;                      // how thick it is in the middle of its vertices
    std::array<std::vector<std::uint32_t>, 2> thicker = {},
                                              others = {};  // that meet it there, the thickest first
    Box box = {};                                           // round the tube
    bool is_hidden = false;                                 // in the tubes of others, whole

    std::uint32_t at(std::size_t which, std::size_t n) const {  // the n-th from an end
      return vertices[index(which, n)];
    }
    std::size_t index(std::size_t which, std::size_t n) const {
      return which == 0 ? n : vertices.size() - 1 - n;
    }
  };

  static double across(const Ring& ring, const Vec3& way);
  Limb cut(std::vector<std::uint32_t> line);
  bool is_joint(std::uint32_t vertex) const { return !at_joint_[vertex].empty(); }
  void add_rings(const EllipseAt& ellipse_at, Limb& limb) const;
  std::size_t in_joint(const Limb& limb, std::size_t end) const;
  struct Free {
    std::array<std::size_t, 2> from;  // vertices from either end, where it leaves its joint
    bool is_any = true;               // else all of it lies in joints
  };
  Free free_part(const Limb& limb) const;
  Ring leaving(const Limb& limb, const Free& free, std::size_t end) const;
  double beyond_joint(const Limb& limb, std::size_t end, const Ring& leaving) const;
  void go_on_into_joints(Limb& limb);
  void compare(Limb& limb, std::size_t end) const;
  void find_hidden();
  template <class Fulfils>
  bool any_beside(const Limb& limb, const Fulfils& fulfils) const;
  double depth_below(const Limb& limb, std::size_t n, const Vec3& at) const;
  std::size_t nearest_in(const Limb& limb, const Vec3& at) const;
  std::uint32_t own_vertex(const Limb& limb, std::size_t n) const;
  bool holds(const Limb& limb, const Vec3& at) const;
  std::uint32_t off_joint(std::uint32_t vertex, const Vec3& at) const;
  static bool is_handle_of(const Limb& loop, const Limb& limb);
  std::uint32_t nearest_beside(std::uint32_t vertex, const Vec3& at) const;
  const Limb* thicker_about(const Limb& limb, const Vec3& at) const;
  double outside_hub(std::uint32_t joint, const Vec3& at) const;
  std::uint32_t about_hub(std::uint32_t joint, const Vec3& at) const;

  std::span<const Vec3> places_;
  std::span<const double> ball_, radius_;
  std::span<const std::vector<LimbFork>> forks_;  // per vertex
  LimbHubs hubs_;
  std::vector<JointBalls> joints_;  // per vertex
  std::vector<Limb> limbs_;
  std::vector<std::uint32_t> limb_of_, rank_;  // per vertex that is no joint: its limb, and its place there
  std::vector<char> is_shared_;                // per vertex: near a joint, or in a thicker limb's tube
  std::vector<std::vector<std::uint32_t>> at_joint_;  // per joint: its limbs, one that comes back to it twice
};

}  // namespace affskel::core
