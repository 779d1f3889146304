#pragma once

#include <utility>

#include "core/curve/limb_sections.h"
#include "core/mesh/mesh.h"
#include "core/spatial/distance_to_mesh.h"

namespace affskel::core {

/// The surface of a solid, with what tells how thick that is: made once, as trees over it take time.
struct LimbSurface {
  const Mesh mesh;
  const LimbSections sections{mesh};
  const DistanceToMesh distance{mesh};

  /// @param closed bounds a solid.
  explicit LimbSurface(Mesh closed) : mesh(std::move(closed)) {}
  LimbSurface(const LimbSurface&) = delete;  // the others refer to the mesh
  LimbSurface& operator=(const LimbSurface&) = delete;

  /// See LimbSections::thickness(); in the ball about a place within.
  double thickness(const Vec3& place) const { return sections.thickness(place, distance.nearest(place)); }
};

}  // namespace affskel::core
