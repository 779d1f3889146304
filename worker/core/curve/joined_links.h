#pragma once

#include <span>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/curve/sheet_lines.h"

namespace affskel::core {

/// Makes one joint of those that lie in each other's balls: where three limbs and more meet, a collapse leaves joints
/// of three lines, with short links between them, whose order is chance.  A link between two joints is drawn together
/// when they, and all that they have been made of, are less than 1.3 of the smaller one's balls apart, or lie in the
/// larger one's, or 1.3 of it where it is twice as large, where nothing but the link holds its ends together, and the link
/// itself lies in their balls, the shortest first; the joint of the larger ball stays, of equal ones the one nearer to the middle of all.  What is left
/// has the same pieces and tunnels.
/// @param places, ball per vertex of the sheet that the lines are of.
/// @throws CoreError kCancelled when the context asks to stop.
SheetLines joined_links(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball,
                        ExecutionContext* context = nullptr);

}  // namespace affskel::core
