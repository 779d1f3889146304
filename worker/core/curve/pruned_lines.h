#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/curve/sheet_lines.h"

namespace affskel::core {

struct PruningOptions {
  /// How many loops are opened at most.  Noise that makes a surface cross itself bores tunnels through a limb, and lines
  /// lead round them: loops all of which lies within kHandle times the ball about one of their vertices.
  std::uint64_t most_loops = 0;
  double least_reach = 0.9;             ///< of the limbs that stay of these, see CurveOptions
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// Leaves out of lines what is no limb: loops as above, opened where they come nearest to the surface, those with the
/// smallest balls first, and eaten up to where lines meet, but for what is as long as a limb; then spurs, which end less
/// than kSpur radii outside the ball about a place of another line.
/// @param places, ball per vertex of the sheet that the lines are of.
/// @param ends per vertex of it: not 0 where a line ends that stays; those that come to it are added.
/// @throws CoreError kCancelled when the context asks to stop.
SheetLines pruned_lines(const SheetLines& lines, std::span<const Vec3> places, std::span<const double> ball,
                        std::vector<char>& ends, const PruningOptions& options);

inline constexpr double kHandle = 2, kSpur = 0.6;

}  // namespace affskel::core
