#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
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
  ExecutionContext* context = nullptr;  ///< asked whether to stop, at every layer
};

struct ErodedSurface {
  Mesh mesh;          ///< mesh units
  double volume = 0;  ///< that the mesh encloses, exact but for rounding; mesh units cubed
};

/// The boundary of the eroded solid {x in V : E(x) >= level}: closed, outward-oriented and manifold (whatever
/// the field is), one piece for every wall of every component; empty when no sample point reaches the level.
///
/// Marching tetrahedra (Doi & Koide 1991) on the Freudenthal split of the lattice with one layer of places
/// outside it.  A vertex lies on an edge of the split between a sample point above the level and a place that
/// is not in the eroded solid, or is cut off from it by the surface of V: where E falls to the level or,
/// where E has a limit above the level (at concave parts), on the surface of V (see level_crossing.h and
/// lattice_cuts.h).  So two sample points above the level with a gap of V between them, however narrow, are
/// not joined along their edge.  Short edges are collapsed onto one of their ends (see tidy_mesh.h), so
/// every vertex is such a crossing, at most a voxel's diagonal away from a sample point above the level,
/// except those that close the end of a gap narrower than the spacing.
///
/// Where E jumps (chordal pieces that begin to take in another part of the solid), the data leave a vertex
/// open on its edge, and it settles evenly among its neighbours (see loose_vertices.h).
///
/// Accuracy, measured: on a ball of radius 1, with the level's ball of radius r, vertices lie within 0.02
/// spacings of it at the spacings 0.1 and 0.05 (0.05 within a spacing of the surface), and the volume falls
/// short by 0.4 (spacing / r)^2 of itself or less; on a torus of radii 2 and 0.7, levels of 0.001 to 0.03 v0,
/// halving the spacing from 0.2 to 0.1 changes the volume by less than 2 %.
///
/// All that decides the mesh's shape happens in lattice coordinates; the vertices are then mapped to mesh
/// units, so lattices in affinely mapped frames give affinely mapped surfaces.  The result is a function of
/// its arguments alone.
///
/// Memory: 16 bytes for every place of a layer of the box across axis 0, and up to about 180 (measured on
/// bodies, needles and plates) for every edge of the split that the surface of V or the result crosses. Time:
/// in the order of the sample points, of those edges (with a logarithm, for sorting), of the lattice's lines
/// along axis 2 and of the triangles' lengths in steps; and a few nanoseconds for every place between the
/// outermost eroded points of four neighbouring lines along axis 2.
/// @throws CoreError kBadInput when the level is not a finite number >= 0, the shortest edge not in [0, 1),
///   or the field is not one of this lattice.
ErodedSurface eroded_surface(const Solid& solid, const Lattice& lattice, const FrameField& field,
                             const ErodedSurfaceOptions& options);

}  // namespace affskel::core
