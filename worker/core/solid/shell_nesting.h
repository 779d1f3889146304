#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// How the closed surfaces of a mesh lie in one another.
struct ShellNesting {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::vector<std::uint32_t> depth;   ///< number of surfaces round this one
  std::vector<std::uint32_t> parent;  ///< the innermost surface round it, or kNone
};

/// Surface A lies inside B when A's box lies in B's and the (up to six) extreme vertices of A are inside
/// B; surfaces that merely cross each other are therefore side by side.  `triangle_shell` gives the
/// surface of each triangle, 0 .. shells - 1.  O(N) per pair of surfaces whose boxes nest.
ShellNesting nest_shells(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell,
                         std::uint32_t shells);

}  // namespace affskel::core
