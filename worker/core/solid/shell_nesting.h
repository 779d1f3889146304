#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/none.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct ShellNestingOptions {
  unsigned threads = 1;                 ///< >= 1, for the tree; the nesting does not depend on it
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// How the closed surfaces of a mesh lie in one another.
struct ShellNesting {
  std::vector<std::uint32_t> depth;   ///< number of surfaces round this one
  std::vector<std::uint32_t> parent;  ///< the innermost surface round it, or kNone
  std::uint64_t tests = 0;            ///< triangles that rays were compared with: what it cost
};

/// Surface A lies inside B when A's box lies in B's and the (up to six) extreme vertices of A are inside
/// B; surfaces that merely cross each other are therefore side by side.  `triangle_shell` gives the
/// surface of each triangle, 0 .. shells - 1.
///
/// O(N log N) in time and O(N) in memory where surfaces neither touch nor cross; how deep they are nested
/// does not matter.  Within a group of surfaces that touch or cross, six rays per surface count what they
/// meet.
/// @throws CoreError kCancelled when the context asks to stop.
ShellNesting nest_shells(const Mesh& mesh, const std::vector<std::uint32_t>& triangle_shell,
                         std::uint32_t shells, const ShellNestingOptions& options = {});

}  // namespace affskel::core
