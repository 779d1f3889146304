#pragma once

#include <vector>

#include "core/base/execution_context.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// How deep a sample point lies in the solid, in spacings: the least d(y) + l(x, y) over the sample points y,
/// d = E / |grad E| the mean height of a chord over its section, l the length of a way over neighbouring
/// sample points (26; a chamfer distance, Borgefors 1986).  d alone may be long in a thin limb, whose chord
/// is all that lies beyond the point.
/// @param field of this lattice.
/// @return per sample point.
/// @throws CoreError kCancelled, as surface_distance() does, when the context asks to stop.
std::vector<float> local_depth(const Lattice& lattice, const FrameField& field,
                               ExecutionContext* context = nullptr);

/// How far a sample point lies from the surface, in spacings: 1/2 where a lattice edge from it leaves the
/// solid, else that of the nearest such point and the way to it, measured alike.
/// @return per sample point.
std::vector<float> surface_distance(const Lattice& lattice, ExecutionContext* context = nullptr);

/// Whether no place next to a sample point is nearer to the surface than `least` spacings, as far as its
/// surface_distance() tells: a place is nearer than the point by a spacing at most, the point than half a spacing, and
/// ways along the three kinds of diagonals are longer than straight ones by 14 % at most.
constexpr bool is_surely_deep(double radius, double least) {
  return radius - 1.75 >= 1.14 * least;
}

}  // namespace affskel::core
