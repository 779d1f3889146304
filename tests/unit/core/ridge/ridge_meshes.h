#pragma once

#include <cstdint>
#include <functional>

#include "core/quality/sheet_topology.h"
#include "core/ridge/ridge_mesh.h"

namespace affskel::core {

/// Meshes for the tests of the operator `ridge`.

/// The square [0, n] x [0, n] of unit cells in the plane z = 0, each of two triangles; vertex (i, j) is
/// j (n + 1) + i.
RidgeMesh square(std::uint32_t n, const std::function<double(double, double)>& strength);

/// Sheet and curves together.
SheetTopology topology(const RidgeMesh& mesh);

}  // namespace affskel::core
