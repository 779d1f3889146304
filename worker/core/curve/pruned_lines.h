#pragma once

#include <span>

#include "core/base/execution_context.h"
#include "core/contour/sheet_mesh.h"
#include "core/curve/sheet_lines.h"

namespace affskel::core {

/// Leaves spurs out of lines, which lead less than kSpur radii out of the ball about a place of what they hang on, and less
/// than kSlender times as far as they are thick there: a rod on a great ball is a limb, and an arm whose hand comes back to the
/// hip.  One that leads through the place of the greatest E of its piece is none: the solid's middle lies on it.  Of two at the
/// end of a line that are about as long, to kTwin, as the condyles of a bone are, both go or none.
/// @param sheet that the lines are of.
/// @param ball per vertex of it.
/// @param least_thickness what is thinner, noise makes.
/// @throws CoreError kCancelled when the context asks to stop.
SheetLines pruned_lines(const SheetLines& lines, const SheetMesh& sheet, std::span<const double> ball,
                        double least_thickness, ExecutionContext* context = nullptr);

inline constexpr double kSpur = 0.6, kSlender = 2, kTwin = 0.85;

}  // namespace affskel::core
