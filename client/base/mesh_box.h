#pragma once

#include "core/mesh/mesh.h"

namespace affskel::client {

/// A box parallel to the axes, mesh units.
struct Box {
  core::Vec3 low, high;
  core::Vec3 size() const { return high - low; }
  core::Vec3 centre() const { return 0.5 * (low + high); }
  double longest_side() const;
  /// Grows to hold a point.
  void add(const core::Vec3& point);
};

/// The box of the mesh's points, of which there must be one.
Box mesh_box(const core::Mesh& mesh);

}  // namespace affskel::client
