#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/box.h"

namespace affskel::core {

/// The distance from any place to the nearest of a set of points: a balanced k-d tree (Bentley 1975, split
/// at the median of the longest side), built once in O(N log N).  Exact: the answer is that of a search
/// through all points, bit for bit.  Immutable after construction; queries from several threads are safe.
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

  std::size_t size() const { return points_.size(); }

 private:
  /// Of points_[first, first + count); its left half is the next node, its right half `right`.
  struct Node {
    Box box;  // tight
    std::uint32_t first, count;
    std::uint32_t right;  // 0: a leaf
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t count);

  struct Entry {
    Vec3 at;
    std::uint32_t number;
  };

  std::vector<Entry> points_;
  std::vector<Node> nodes_;
};

}  // namespace affskel::core
