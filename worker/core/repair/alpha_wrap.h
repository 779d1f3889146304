#pragma once

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct AlphaWrapOptions {
  double alpha = 0;   ///< radius of the smallest ball that enters the wrap from outside, mesh units; > 0
  double offset = 0;  ///< distance of the wrap from what it wraps, mesh units; > 0.  Taken back afterwards
  ExecutionContext* context = nullptr;
};

/// A closed manifold surface round triangles or points in any state (CGAL's Alpha_wrap_3; Portaneri et al. 2022).
/// Its vertices are then moved inward by the offset, so that the volume is that of what was wrapped, but for
/// hollows narrower than alpha.
/// @param mesh triangles, or points alone. @throws CoreError kBadInput without points, or when nothing is wrapped;
///   kCancelled.
Mesh alpha_wrap(const Mesh& mesh, const AlphaWrapOptions& options);

}  // namespace affskel::core
