#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Shoots rays from vertices of a closed mesh; a bounding volume hierarchy over the triangles (median
/// split of the longest side of the centroids' box), built once, O(N log N), on up to `threads` threads.
/// Immutable afterwards, so threads may share it.
class RayShooter {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  explicit RayShooter(const Mesh& mesh, unsigned threads = 1);

  /// The first triangle that the ray vertex - s d, s >= 0, leaves the solid through: among triangles with
  /// outward normal n, n.d < 0, that do not use the vertex and that `accept`, the one met at the least s
  /// (ties: the smaller index); kNone when there is none.  Borders count as part of a triangle, with a
  /// tolerance of 1e-12 of its size; when nothing is met (the ray hits a corner of slivers) of 1e-9, then
  /// 1e-6.
  std::uint32_t first_exit_below(std::uint32_t vertex, const Vec3& d,
                                 const std::function<bool(std::uint32_t)>& accept) const;

 private:
  struct Box {
    Vec3 low, high;
  };
  // Inner node: children at the next place and at `first`, count 0.  Leaf: triangles_[first .. first +
  // count).
  struct Node {
    Box box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  std::uint32_t first_exit_with_slack(std::uint32_t vertex, const Vec3& d,
                                      const std::function<bool(std::uint32_t)>& accept, double slack) const;
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end, const std::vector<Vec3>& centroids,
             unsigned threads);
  Box bounds(std::uint32_t begin, std::uint32_t end) const;

  const Mesh& mesh_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace affskel::core
