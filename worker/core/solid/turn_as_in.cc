#include "core/solid/turn_as_in.h"

#include <array>
#include <cstddef>
#include <utility>

namespace affskel::core {

bool turn_as_in(const Solid& solid, Mesh& mesh) {
  if (solid.mesh.triangles.size() != mesh.triangles.size()) return false;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    // By the places of corners, for a triangle may have no area, and vertices other numbers there.
    std::array<Vec3, 3> there;
    for (std::size_t k = 0; k < 3; ++k)
      there[k] = solid.centre + solid.scale() * solid.mesh.points[solid.mesh.triangles[t][k]];
    const auto [a, b, c] = mesh.triangles[t];
    const auto away = [&](std::size_t k, std::uint32_t from) {
      return norm(there[k % 3] - mesh.points[from]);
    };
    std::size_t first = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (away(k, a) < away(first, a)) first = k;
    if (away(first + 1, c) < away(first + 1, b)) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return true;
}

}  // namespace affskel::core
