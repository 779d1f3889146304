#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/box.h"
#include "core/spatial/halved_nodes.h"

namespace affskel::core {

/// The distance from any place to the nearest of a set of points, by a balanced tree (see HalvedTree), built once in
/// O(N log N).  Exact: the answer is that of a search through all points, bit for bit.  Immutable after construction;
/// queries from several threads are safe.
class PointIndex {
 public:
  /// @param points finite; copied, so they need not outlive the index.  May be empty.
  explicit PointIndex(std::span<const Vec3> points);

  /// Distance from `place` (finite) to the nearest point, in the points' unit; +infinity without points.
  double nearest(const Vec3& place) const { return find(place).distance; }

  struct Found {
    double distance;       ///< as nearest()
    std::uint32_t number;  ///< of the nearest point, or of one of them; undefined without points
  };
  Found find(const Vec3& place) const;

 private:
  std::vector<Vec3> points_;
  HalvedTree<Box> tree_;
};

}  // namespace affskel::core
