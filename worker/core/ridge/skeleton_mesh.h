#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"
#include "core/contour/edge_cells.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"
#include "core/ridge/ridge_anchors.h"
#include "core/ridge/smoothed_derivatives.h"
#include "core/solid/solid.h"
#include "core/spatial/distance_to_mesh.h"

namespace affskel::core {

/// What is known of the places of a collapsed complex.
struct SkeletonParts {
  const Lattice& lattice;
  const SolidParts& parts;
  const FrameField& field;
  const EdgeCells& cells;                ///< that the ridge surface passes through
  std::span<const SheetVertex> surface;  ///< its vertex in each of these cells
  const RidgeAnchors& anchors;
  std::span<const PointDerivatives> derivatives;  ///< of P
  std::span<const float> radius;                  ///< per sample point: see surface_distance()
  const DistanceToMesh& nearest;                  ///< of the solid's surface, lattice coordinates
  double low;                                     ///< the strength at which the surface ends
};

/// A skeleton whose lines end in the middle of the ends of limbs, and what it has instead where they are drawn out to the tips.
struct SkeletonMesh : SheetMesh {
  struct Drawn {
    std::uint32_t vertex = 0;
    SheetVertex at;
  };
  std::vector<Drawn> drawn_out;
};

/// Gives the lines of a skeleton their places towards the tips, see drawn_out_lines().
void draw_out(SkeletonMesh& skeleton);

/// Gives the cells of a collapsed complex their places in the solid.
/// 1. Vertices of the ridge surface and of curves have theirs.
/// 2. Rims: where a vertex weaker than `low` lies on a rim, it goes back to the line s = low: to the mean of
///    its places, by linear interpolation, on the ways to its strong neighbours.  Rims are then evened out.
/// 3. All others begin in the middle of the sample points about them, and are drawn to the mean of their
///    neighbours, ways also to where P is greatest across them if that is near, as far as they stay off the
///    surface: they become smooth, and follow a ridge where there is a weak one.  A line's end goes on straight.
/// 4. Lines, curves too, are unbent between their ends and branches.
/// 5. Where lines are drawn out to is told beside.
/// @param left of the complex: squares, edges and vertices, closed under taking boundaries.
/// @return a vertex for each of the complex, two triangles for each square, a segment for each edge of no
///   square; of edges with the same ends see SkeletonCells.  Triangles agree on their senses, see
///   agree_on_senses().
SkeletonMesh skeleton_mesh(const Solid& solid, const DualComplex& complex, const CellSet& left,
                           const SkeletonParts& from, ExecutionContext* context);

}  // namespace affskel::core
