#pragma once

#include <cstdint>
#include <functional>

#include "core/contour/sheet_mesh.h"
#include "core/quality/sheet_topology.h"
#include "core/ridge/ridge_curves.h"

namespace affskel::core {

/// Meshes for the tests of the operator `ridge`.

/// The square [0, n] x [0, n] of unit cells in the plane z = 0, each of two triangles; vertex (i, j) is
/// j (n + 1) + i.
SheetMesh square(std::uint32_t n, const std::function<double(double, double)>& strength);

/// The square's triangles whose middle (x, y) is wanted; strength 10.
SheetMesh part_of_square(std::uint32_t n, const std::function<bool(double, double)>& wanted);

/// From (low, 15.1, 0.2) to (high, 15.1, 0.2), vertices one apart; strength 7.
RidgeCurve line(double low, double high, double radius);

/// Sheet and curves together.
SheetTopology topology(const SheetMesh& mesh);

}  // namespace affskel::core
