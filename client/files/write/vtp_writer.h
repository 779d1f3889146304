#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "client/files/read/read_shape.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

/// Writes a VTK XML PolyData file, as ParaView and VTK >= 6 read it: triangles as polygons, points alone as
/// one vertex each, coordinates as Float64; arrays raw and little-endian behind the text, with 64 bit
/// lengths.
/// @param columns become point arrays, whole ones Int32 or UInt32 where all values fit, the others Float64;
/// three in a row that belong together become one array of three (see array_of_columns).  E is the active
/// array, by which ParaView colours.
/// @param comments become the strings of the field array "comment".
/// @param write takes the bytes, piece by piece.
void write_vtp(const core::Mesh& mesh, const std::vector<PointColumn>& columns,
               const std::vector<std::string>& comments, const std::function<void(std::string_view)>& write);

}  // namespace affskel::client
