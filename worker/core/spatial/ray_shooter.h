#pragma once

#include <cstdint>
#include <functional>

#include "core/base/none.h"
#include "core/mesh/mesh.h"
#include "core/spatial/box_tree.h"

namespace affskel::core {

/// Shoots rays from vertices of a closed mesh, through a tree of its triangles' boxes, which is built once:
/// O(N log N), on up to `threads` threads.  Immutable afterwards, so threads may share it.  Keeps a reference
/// to the mesh.
class RayShooter {
 public:
  explicit RayShooter(const Mesh& mesh, unsigned threads = 1);

  /// The first triangle that the ray vertex - s d, s >= 0, leaves the solid through: among triangles with
  /// outward normal n, n.d < 0, that do not use the vertex and that `accept`, the one met at the least s
  /// (ties: the smaller index); kNone when there is none.  Borders count as part of a triangle, with a
  /// tolerance of 1e-12 of its size; when nothing is met (the ray hits a corner of slivers) of 1e-9, then
  /// 1e-6.
  std::uint32_t first_exit_below(std::uint32_t vertex, const Vec3& d,
                                 const std::function<bool(std::uint32_t)>& accept) const;

 private:
  const Mesh& mesh_;
  BoxTree tree_;
};

}  // namespace affskel::core
