#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

struct LocalThicknessOptions {
  unsigned threads = 1;                 ///< >= 1; the result does not depend on it
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// How thick the solid is about sample points: the radius of the largest ball within that, half as large again, holds one, in
/// spacings.  The local thickness of Hildebrand and Rüegsegger (1997) takes balls that hold the place itself: beside an
/// edge, where these are small, it tells nothing of a plate.  Of balls about sample points, found on a way on which they
/// grow.
/// @param distance per sample point: see surface_distance().
/// @param points sample points, or kNone, whose thickness is infinite.
/// @return per one of `points`.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<float> local_thickness(const DualComplex& complex, std::span<const float> distance,
                                   std::span<const std::uint32_t> points,
                                   const LocalThicknessOptions& options = {});

}  // namespace affskel::core
