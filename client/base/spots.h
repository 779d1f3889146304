#pragma once

#include <cstdint>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

/// A vertex of every piece that is less than `size` long along each axis, such as the centre of a ball: as a surface or
/// a line nobody would see it.
/// @param size in the units of the sheet.
std::vector<std::uint32_t> spots_of(const v1::TriangleMesh& sheet, double size);

}  // namespace affskel::client
