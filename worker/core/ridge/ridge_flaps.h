#pragma once

#include <cstdint>

#include "core/contour/sheet_mesh.h"

namespace affskel::core {

/// Cuts small flaps off a sheet: where more than two triangles meet at an edge, the least of the patches that
/// meet there, until two are left.  Patches are what triangles form through edges of exactly two.  Where the
/// direction across the sheet is nearly arbitrary, as in round limbs, neighbouring lattice edges see sheets
/// of different directions, which cross; together they enclose pockets that are no tunnels of the solid.
/// Branches larger than that stay.
/// @param max_share flaps of at most this share of their piece's area are cut off.
/// @return how many patches were cut off.
std::uint32_t cut_flaps(SheetMesh& mesh, double max_share);

}  // namespace affskel::core
