#pragma once

#include <span>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/curve/sheet_lines.h"

namespace affskel::core {

/// Leaves spurs out of lines, which end less than kSpur radii outside the ball about a place of what they hang on.
/// @param places, ball per vertex of the sheet that the lines are of.
/// @throws CoreError kCancelled when the context asks to stop.
SheetLines pruned_lines(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball,
                        ExecutionContext* context = nullptr);

inline constexpr double kSpur = 0.6;

}  // namespace affskel::core
