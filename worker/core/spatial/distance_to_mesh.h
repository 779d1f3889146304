#pragma once

#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"
#include "core/spatial/box_tree.h"
#include "core/spatial/point_index.h"

namespace affskel::core {

/// The distance from any place to the surface of a mesh.  Keeps a reference to the mesh.  Immutable after
/// construction; queries from several threads are safe.
class DistanceToMesh {
 public:
  /// O(N log N), on up to `threads` threads.
  /// @param mesh of one triangle at least, of which two corners may be one: a segment.
  explicit DistanceToMesh(const Mesh& mesh, unsigned threads = 1);

  /// To the nearest point of a triangle, in the mesh's unit.
  double nearest(const Vec3& place) const;

  /// That point.
  Vec3 nearest_place(const Vec3& place) const;

 private:
  const Mesh& mesh_;
  BoxTree tree_;
  const std::vector<Vec3> corners_;  // of triangles, each once
  const PointIndex corner_index_;    // what is farther away than the nearest corner need not be looked at
};

/// The point of a triangle, its inside and its sides, that is nearest to a place (Ericson, Real-Time Collision
/// Detection, 2005, 5.1.5).  Two corners may coincide: a segment.
Vec3 nearest_place(const Vec3& place, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace affskel::core
