#pragma once

#include <cstdint>
#include <functional>

#include "core/base/vec3.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Joins pieces of a skeleton that lie apart in one part of the solid by polylines, where no ridge leads from
/// one to the other: over the saddles of E between limbs and trunk.
/// 1. Ways lead along the lattice's edges within the solid, and from a vertex of the skeleton to its sample
///    point.  An edge costs its length by the mean of sqrt(E) at its ends, so that ways keep to the middle.
/// 2. From all pieces but the largest of a part at once the cheapest ways to other pieces are searched
///    (Dijkstra 1959); of those the cheapest that join what is not yet joined stay (Kruskal 1956).  Longer
///    ones are left out.
/// 3. Their inner vertices are moved towards the middle of their neighbours a few times, where that does not
///    leave the solid.  They have E and area of their sample points, and strength 0.
/// A function of mesh, field and solid alone.
/// @param field of the lattice.
/// @param inside whether a place, frame coordinates, lies in the solid.
/// @param max_length the longest way, in the radius of the larger section at its two ends.
/// @return how many ways were put in.
std::uint32_t join_pieces(SheetMesh& mesh, const Lattice& lattice, const FrameField& field,
                          const std::function<bool(const Vec3&)>& inside, double max_length);

}  // namespace affskel::core
