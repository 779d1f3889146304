#pragma once

#include <span>

#include "core/base/execution_context.h"
#include "core/base/matrix3.h"

namespace affskel::core {

/// A box about points: orthonormal axes and their volume.
struct FittedBox {
  Matrix3 axes = kIdentity3;
  double volume = 0;  ///< the product of the sides along the axes
};

/// Turns a box about one of its axes after the other until no such turn makes it smaller: a local minimum of
/// the volume (Freeman & Shapira 1975).  The axes follow from edges between the points, so small errors of
/// the start are forgotten.  Uses +, -, *, / and sqrt only.
/// @param points at least one.
/// @param start nearly orthonormal axes.
/// @throws CoreError kCancelled when the context asks to stop: points on a circle take the square of their
/// number.
FittedBox shrink_box(std::span<const Vec3> points, const Matrix3& start, ExecutionContext* context = nullptr);

}  // namespace affskel::core
