#pragma once

#include <cstdint>
#include <functional>

#include "core/base/vec3.h"
#include "core/contour/sheet_mesh.h"

namespace affskel::core {

/// Closes small holes of a sheet, each by a fan about the middle of its rim.  Rims are followed along edges
/// of one triangle; where two rims touch they are parted.  A piece's longest rim stays, as its outline does,
/// and so does a hole whose fan would leave the solid.
/// @param inside whether a place (frame coordinates) lies in the solid.
/// @param max_share holes whose rim spans at most this share of their piece's area are closed.
/// @return how many were closed.
std::uint32_t close_holes(SheetMesh& mesh, const std::function<bool(const Vec3&)>& inside, double max_share);

}  // namespace affskel::core
