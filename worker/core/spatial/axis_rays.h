#pragma once

#include <cstdint>

#include "core/base/none.h"
#include "core/mesh/mesh.h"
#include "core/spatial/box_tree.h"

namespace affskel::core {

/// Rays parallel to the axes against a closed surface, through a tree of the triangles' boxes.  Triangles at
/// a common edge or vertex are told apart exactly (see winding_round_line).  Keeps a reference to the mesh.
/// Immutable after construction; queries from several threads are safe.
class AxisRays {
 public:
  struct Hit {
    std::uint32_t triangle = kNone;  ///< the first that the ray crosses; kNone: it crosses none
    int winding = 0;                 ///< how often the surface winds round the ray's origin
  };

  /// @param mesh closed. @param threads for the tree.
  explicit AxisRays(const Mesh& mesh, unsigned threads = 1);

  /// The ray from q along the axis (0, 1, 2), `upward` or against it; what lies at q itself is not crossed.
  /// Of triangles that are crossed at the same place the first has the least index.
  Hit shoot(const Vec3& q, int axis, bool upward) const;

 private:
  const Mesh& mesh_;
  BoxTree tree_;
};

}  // namespace affskel::core
