#pragma once

#include <algorithm>
#include <string>

#include "core/mesh/mesh.h"
#include "core/repair/repair_mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// What tests of repairs look at.

/// Of the solid that it bounds.
inline double volume_of(const Mesh& mesh) {
  return make_solid(mesh).volume;
}

/// A hole: the triangles whose corners all lie within `radius` of a point.
inline Mesh cut(const Mesh& mesh, const Vec3& at, double radius) {
  Mesh open = mesh;
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](std::uint32_t v) { return norm(mesh.points[v] - at) < radius; });
  });
  return open;
}

/// The step of this code; null where it was not done.
inline const RepairStep* step(const RepairedMesh& repaired, const std::string& code) {
  const auto found = std::find_if(repaired.steps.begin(), repaired.steps.end(),
                                  [&](const RepairStep& s) { return s.code == code; });
  return found == repaired.steps.end() ? nullptr : &*found;
}

}  // namespace affskel::core
