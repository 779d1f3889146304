#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/erosion/field_between.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Ranks of the sample points with E >= `level` (mesh units cubed), in lattice order.
std::vector<std::uint32_t> eroded_points(const FrameField& field, double level);

struct ErodedSurfaceOptions {
  double level = 0;  ///< E of the surface, mesh units cubed, >= 0
  /// Shorter ones are collapsed where the shape allows it; spacings, < 1; 0 = none.
  double shortest_edge = 0.4;
  ExecutionContext* context = nullptr;  ///< asked whether to stop, at every layer and round
};

struct ErodedSurface {
  Mesh mesh;                       ///< mesh units
  std::vector<PlaceValue> values;  ///< E and its slope, per vertex, see field_between
  double volume = 0;               ///< that the mesh encloses, exact but for rounding; mesh units cubed
};

/// The boundary of the eroded solid {x in V : E(x) >= level}: closed, outward-oriented and manifold, whatever
/// the field is, one component for every wall of every component; empty when no sample point reaches the
/// level.  By marching tetrahedra (Doi & Koide 1991); how, and how accurate: eroded_solid.cc.
///
/// Vertices are at most a voxel's diagonal away from a sample point above the level, except those that close
/// the end of a gap of V narrower than the spacing.  A lattice in an affinely mapped frame gives the affinely
/// mapped surface.  A function of the arguments alone.
///
/// Memory: 16 bytes for every place of a layer of the box, and up to about 180 for every edge of the split
/// that the surface of V or the result crosses.  Time: in the order of sample points, lattice lines and those
/// edges.
/// @throws CoreError kBadInput when the level is not a finite number >= 0, the shortest edge not in [0, 1),
///   or the field is not one of this lattice; kCancelled when the context asks to stop.
ErodedSurface eroded_surface(const Solid& solid, const Lattice& lattice, const FrameField& field,
                             const ErodedSurfaceOptions& options);

}  // namespace affskel::core
