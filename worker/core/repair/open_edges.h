#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Joins ends of open edges that lie within a millionth of the box's diagonal of each other, and within a hundredth of
/// every open edge that ends at either: corners of one vertex that rounding has parted.  The first of them stands for
/// all; points do not move.
/// @return how many points were joined to another, which no triangle names any more.
/// @throws CoreError kCancelled when the context, if there is one, asks to stop.
std::uint64_t join_near_points(const std::vector<Vec3>& points, std::vector<Triangle>& triangles,
                               ExecutionContext* context = nullptr);

/// Splits triangles at T-junctions: where a vertex of the rim lies on an open edge of a triangle, within a millionth of
/// the box's diagonal and a thousandth of the edge, the triangle is cut there, so that the edge can meet those of the
/// other side.  Nothing moves.
/// @return how many vertices were put into edges.
std::uint64_t split_t_junctions(const std::vector<Vec3>& points, std::vector<Triangle>& triangles);

}  // namespace affskel::core
