#pragma once

#include <array>

#include "core/base/vec3.h"
#include "core/quality/sheet_topology.h"
#include "core/ridge/ridge_sheet.h"

namespace affskel::core {

/// Of a lattice along the coordinate axes, spacing h, stretched.
inline std::array<Vec3, 3> axes(double h, double x = 1, double y = 1, double z = 1) {
  return {Vec3{h * x, 0, 0}, Vec3{0, h * y, 0}, Vec3{0, 0, h * z}};
}

/// Of triangles and segments.
inline BettiNumbers topology(const RidgeSheet& sheet) {
  Mesh mesh;
  for (const SheetVertex& v : sheet.vertices) mesh.points.push_back(v.position);
  mesh.triangles = sheet.triangles;
  return sheet_betti_numbers(mesh, sheet.segments);
}

}  // namespace affskel::core
