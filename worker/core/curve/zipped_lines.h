#pragma once

#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/curve/sheet_lines.h"

namespace affskel::core {

/// Lets lines share their way where they run side by side from a joint on: where each place of one lies in the largest
/// ball about a place of the other and the other way round, to beyond the largest ball about the joint.  The line of the
/// smaller balls then leaves the other where it parts from it: its end slides along the other, which changes neither
/// pieces nor tunnels.  Where a joint then is one no more, the two lines that are left may double back: they share what
/// lies side by side within its ball, too, and an end that is none that stays is eaten.
/// @param ends per vertex of the sheet that the lines are of: not 0 where a line ends that stays.
/// @param ball per vertex of it.
/// @param spacing of vertices along what is new.
/// @param places per vertex of it; what leads from one line to another is drawn straight.
/// @throws CoreError kCancelled when the context asks to stop.
SheetLines zipped_lines(const SheetLines& lines, std::span<const char> ends, std::span<const double> ball,
                        double spacing, std::vector<Vec3>& places, ExecutionContext* context = nullptr);

}  // namespace affskel::core
