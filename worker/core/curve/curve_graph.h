#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/none.h"
#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// By its ends: one is free; both are; none; it closes; a vertex without a line.
enum class BranchKind : std::uint8_t { kLimb, kLine, kLink, kLoop, kPoint };

/// A line between two nodes.
struct CurveBranch {
  BranchKind kind = BranchKind::kLimb;
  /// Nodes; the same for a loop and a point.  A limb's free end is `to`, of a link's ends `from` where it meets
  /// the branch that comes first.
  std::uint32_t from = 0, to = 0;
  std::vector<std::uint32_t> vertices;  ///< from one to the other
  double length = 0;                    ///< along the line, from where it leaves a body that it hangs on
  double straight_length = 0;           ///< from end to end of that
  double share = 0;                     ///< see CurveGraph::part; 0 when no vertex is its own
  /// Of its own vertices, see CurveGraph::part, without joints, or of all where it has none; the mean along the line.
  double mean_radius = 0, least_radius = 0, greatest_radius = 0;
  /// Degrees, at `from`, to the heaviest other branch there: 180 goes straight on; NaN without another, and of a point.
  double angle = 0;
  std::uint32_t angle_to = kNone;  ///< which branch that is
};

/// A curve skeleton as a graph.
struct CurveGraph {
  /// Vertices: ends, places where lines meet, one of each loop without these, and vertices without a line;
  /// ascending.
  std::vector<std::uint32_t> nodes;
  std::vector<std::uint32_t> degree;  ///< per node: ends of branches there
  /// The greatest share first.  Shares that are about equal, each at least kAboutEqual of the one before, are in
  /// the order of their mean places, along the axis in which these are farthest apart: the two arms of a body do not
  /// change places with noise.
  std::vector<CurveBranch> branches;
  /// Per vertex: its branch.  Where branches meet, the heaviest, or the body if there is one; it also has the vertices
  /// of the others up to the first that has a share: a limb begins where it leaves the trunk, see limb_tubes().
  std::vector<std::uint32_t> part;

  static constexpr double kAboutEqual = 0.95;
};

/// A point is a branch of its own, of one vertex, and so is a body that branches hang on: a place where they meet that has
/// a share (see limb_hubs()).
/// @param places, radius, share per vertex: see limb_radii(), CurveSkeleton::share; segments as for polylines().
CurveGraph curve_graph(std::span<const Vec3> places, std::span<const Segment> segments,
                       std::span<const double> radius, std::span<const double> share);

}  // namespace affskel::core
