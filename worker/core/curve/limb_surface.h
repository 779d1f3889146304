#pragma once

#include <utility>

#include "core/curve/limb_sections.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid_membership.h"
#include "core/spatial/distance_to_mesh.h"

namespace affskel::core {

/// The surface of a solid, with what tells how thick that is: made once, as trees over it take time.  Immutable after
/// construction; queries from several threads are safe.
struct LimbSurface {
  const Mesh mesh;
  const LimbSections sections;
  const DistanceToMesh distance;
  const SolidMembership membership;

  /// On up to `threads` threads.  @param closed bounds a solid.
  explicit LimbSurface(Mesh closed, unsigned threads = 1)
      : mesh(std::move(closed)),
        sections(mesh, threads),
        distance(mesh, threads),
        membership(mesh, threads) {}
  LimbSurface(const LimbSurface&) = delete;  // the others refer to the mesh
  LimbSurface& operator=(const LimbSurface&) = delete;

  /// See LimbSections::thickness(); in the ball about a place within.
  double thickness(const Vec3& place) const { return sections.thickness(place, distance.nearest(place)); }
};

}  // namespace affskel::core
