#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/contour/sheet_mesh.h"

namespace affskel::core {

/// What sheet_lines() leaves of a sheet.
struct SheetLines {
  std::vector<std::uint32_t> vertices;  ///< of the sheet, ascending
  std::vector<Segment> segments;        ///< by numbers in `vertices`
  std::vector<std::uint32_t> opened;  ///< per closed surface: the vertex of the sheet at which it was opened
};

/// Collapses a sheet with its curves onto lines: triangles leave from the rims inwards, the nearest to a rim
/// first, along the sheet, so that what stays runs in the middle of it (the medial axis of the sheet, as in Yan,
/// Sykes, Chambers, Letscher and Ju, "Erosion thickness on medial axes of 3D shapes", 2016); lines are eaten from
/// ends that are not in `ends`.  Elementary collapses keep pieces and tunnels (Whitehead 1939).  A closed surface
/// has no line: it is opened where E is least, and no longer encloses anything.
///
/// A piece with less than two of `ends`, and no tunnel, also keeps the vertex where E is greatest: a ball is that
/// vertex, a drop the line from there to its tip.  With one end, and a line through that vertex which ends beyond it, as in
/// the body of a bottle, that line stays instead.  A function of its arguments alone.
/// @param ends per vertex: not 0 where a line ends that stays.
/// @throws CoreError kCancelled when the context asks to stop.
SheetLines sheet_lines(const SheetMesh& sheet, std::span<const char> ends,
                       ExecutionContext* context = nullptr);

/// The vertices that stay of lines, with these segments between them.
/// @param stays, segments by numbers in lines.vertices.
SheetLines numbered_anew(const SheetLines& lines, std::span<const char> stays, std::vector<Segment> segments);

/// What is left of lines: these segments between their vertices, without the vertices that had some and have none any more.
SheetLines left_of(const SheetLines& lines, std::vector<Segment> segments);

}  // namespace affskel::core
