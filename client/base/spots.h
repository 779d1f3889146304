#pragma once

#include <cstdint>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "core/base/disjoint_sets.h"
#include "core/base/vec3.h"

namespace affskel::client {

/// The vertices of a sheet, those of a triangle or segment in one set.  Its corners exist.
core::DisjointSets pieces_of(const v1::TriangleMesh& sheet);

/// The place of a vertex.
core::Vec3 vertex_of(const v1::TriangleMesh& sheet, std::uint32_t v);

/// A vertex of every piece that is less than `size` long along each axis, such as the centre of a ball: as a surface or
/// a line nobody would see it.
/// @param size in the units of the sheet.
std::vector<std::uint32_t> spots_of(const v1::TriangleMesh& sheet, double size);

}  // namespace affskel::client
