#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"
#include "core/spatial/box_tree.h"

namespace affskel::core {

/// The closed surfaces of a mesh that matter for how they lie in one another.
struct NestingShells {
  std::vector<Box> box;                  ///< per surface
  std::vector<std::uint8_t> matters;     ///< per surface: its box lies in another's, or holds another's
  std::vector<std::uint32_t> triangles;  ///< of the surfaces that matter, ascending
};

/// Whether `inner` lies in `outer`, no side of one touching the other's.
inline bool lies_strictly_in(const Box& inner, const Box& outer) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(outer.low[k] < inner.low[k] && inner.high[k] < outer.high[k])) return false;
  }
  return true;
}

/// O(N + S log S) for S surfaces unless boxes lie on one another in heaps.
/// @param triangle_shell the surface of each triangle, 0 .. shells - 1.
/// @throws CoreError kCancelled when the context asks to stop.
NestingShells nesting_shells(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell,
                             std::uint32_t shells, ExecutionContext* context = nullptr);

/// Groups surfaces that touch or cross each other, and those joined by others that do; exact.  Two surfaces
/// of different groups have no point in common.  Looks at the triangles of all surfaces but the largest:
/// O(N log N) and the pairs of boxes of triangles that meet.
/// @param tree over the boxes of `shells.triangles`, by their position in the list.
/// @return per surface the least index in its group.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<std::uint32_t> shell_groups(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell,
                                        const NestingShells& shells, const BoxTree& tree,
                                        ExecutionContext* context = nullptr);

}  // namespace affskel::core
