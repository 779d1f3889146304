#pragma once

#include <cstdint>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Triangles that agree with their neighbours, and what that took.
struct OrientedSoup {
  Mesh mesh;                        ///< edge- and vertex-manifold, possibly with boundary
  std::uint64_t welded_points = 0;  ///< equal points that became one
  std::uint64_t joined_points =
      0;  ///< so near another one that rounding has parted them, see join_near_points
  std::uint64_t unused_points = 0;  ///< that no triangle names
  std::uint64_t degenerate = 0;     ///< triangles that name a point twice, or have no area as a line has none
  std::uint64_t repeated = 0;       ///< triangles beside another of the same corners
  std::uint64_t junctions = 0;      ///< points put into open edges that they lie on, see split_t_junctions
  std::uint64_t turned = 0;         ///< triangles that disagreed with most of their part
  std::uint64_t separated_points =
      0;  ///< points that were doubled: where more than two triangles meet at an edge, or
          ///< parts touch in a point
  std::uint64_t stitched_edges = 0;  ///< pairs of boundary edges between the same points that became one
};

/// Makes a surface of triangles in any order and sense (CGAL's repair and orientation of polygon soups, stitching of
/// borders).  Points do not move.
/// @param mesh with finite points. @param context may be null.
/// @throws CoreError kBadInput when no triangle is left, kCancelled.
OrientedSoup orient_soup(const Mesh& mesh, ExecutionContext* context = nullptr);

}  // namespace affskel::core
