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

/// Of an eroded solid, with a basis of its own.
template <class Eroded>
RidgeSheet ridge_of(const Eroded& eroded, const RidgeSheetOptions& options = {}) {
  const RidgeBasis basis = ridge_basis(eroded.solid, eroded.lattice, eroded.field, 1, options.context);
  return ridge_sheet(eroded.solid, eroded.lattice, eroded.field, basis, options);
}

/// Of triangles and segments.
inline BettiNumbers topology(const RidgeSheet& sheet) {
  Mesh mesh;
  for (const SheetVertex& v : sheet.vertices) mesh.points.push_back(v.position);
  mesh.triangles = sheet.triangles;
  return sheet_betti_numbers(mesh, sheet.segments);
}

}  // namespace affskel::core
