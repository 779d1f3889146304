#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/contour/sheet_mesh.h"
#include "core/curve/lattice_windings.h"

namespace affskel::core {

/// What sheet_lines() leaves of a sheet.
struct SheetLines {
  std::vector<std::uint32_t> vertices;  ///< of the sheet, ascending
  std::vector<Segment> segments;        ///< by numbers in `vertices`
  std::uint32_t opened = 0;             ///< closed surfaces, opened
  std::uint32_t loops = 0;              ///< loops that bound in the solid, opened
};

struct SheetLinesOptions {
  /// Of the solid: loops that go round none of its tunnels are opened, where E is least; null: all stay.
  const LatticeWindings* windings = nullptr;
  std::span<const double>
      radius;              ///< with `windings`, per vertex: distance to the surface, frame coordinates
  double least_reach = 0;  ///< with `windings`: see CurveOptions
  ExecutionContext* context = nullptr;
};

/// Collapses a sheet with its curves onto lines: triangles leave from the rims inwards, the nearest to a rim
/// first, along the sheet, so that what stays runs in the middle of it (the medial axis of the sheet, as in Yan,
/// Sykes, Chambers, Letscher and Ju, "Erosion thickness on medial axes of 3D shapes", 2016); lines are eaten from
/// ends that are not in `ends`.  Elementary collapses keep pieces and tunnels (Whitehead 1939).  A closed surface
/// has no line: it is opened where E is least, and no longer encloses anything.
///
/// The lattice may have tunnels that the solid lacks: two fingers joined by a web that is thinner than the spacing at
/// their roots and thicker at their tips.  Such loops are opened where E is least (loops_to_open()).  What then ends
/// there is a limb when it is long enough, by its radius where it leaves the largest ball about its joint; else it is
/// eaten, too.
///
/// A piece with less than two of `ends`, and no tunnel, also keeps the vertex where E is greatest: a ball is that
/// vertex, a drop the line from there to its tip.  A function of its arguments alone.
/// @param ends per vertex: not 0 where a line ends that stays.
/// @throws CoreError kCancelled when the context asks to stop.
SheetLines sheet_lines(const SheetMesh& sheet, std::span<const char> ends,
                       const SheetLinesOptions& options = {});

}  // namespace affskel::core
