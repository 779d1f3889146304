#pragma once

#include <optional>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct AlphaWrapOptions {
  double alpha = 0;          ///< radius of the smallest ball that comes near all of the wrap, mesh units; > 0
  double offset = 0;         ///< distance of the wrap from what it wraps, mesh units; > 0
  std::optional<Vec3> from;  ///< where the ball comes from: a place in a cavity; without it from outside
  ExecutionContext* context = nullptr;
};

/// A closed manifold surface round triangles or points in any state (CGAL's Alpha_wrap_3; Portaneri et al. 2022), but for what
/// the ball does not reach: hollows narrower than alpha and, from outside, cavities, however wide; see wrap_solid.
/// @param mesh triangles, or points alone.
/// @return from a place within: the wall of its cavity, facing into it as a solid's does, and what lies in it; no triangles
///   where there is no room for the ball.
/// @throws CoreError kBadInput without points, or when nothing is wrapped from outside; kCancelled.
Mesh alpha_wrap(const Mesh& mesh, const AlphaWrapOptions& options);

/// Moves the vertices of wraps inward by the offset, so that they hold as much as what was wrapped: less, by halves, where
/// triangles would meet that did not, as those of opposite walls of a hollow that is as narrow as alpha.  What meets itself
/// nowhere does not afterwards.
/// @param wraps all that bound a solid together, facing outward. @throws CoreError kCancelled.
void take_back_offset(Mesh& wraps, const AlphaWrapOptions& options);

}  // namespace affskel::core
