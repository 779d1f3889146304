#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Chains segments into polylines: a point with two segments lies within one, any other ends those that meet
/// there.  A closed polyline begins and ends at its least point.  Each segment is in one of them, once.
/// @param points how many there are; every segment has two of them, different.
/// @return by the first segment of each, in their order.  O(points + segments).
std::vector<std::vector<std::uint32_t>> polylines(std::size_t points, std::span<const Segment> segments);

/// One end of one of several lines.
struct LineEnd {
  std::uint32_t line = 0;
  bool back = false;  ///< by its last point

  bool operator==(const LineEnd&) const = default;
};

/// The n-th point of a line from one of its ends on.
inline std::uint32_t point_from(bool back, std::span<const std::uint32_t> line, std::size_t n) {
  return line[back ? line.size() - 1 - n : n];
}

/// Per point: how many ends of lines it is.
std::vector<std::uint32_t> ends_of(std::size_t points, std::span<const std::vector<std::uint32_t>> lines);

/// Per point: those ends, by line.
std::vector<std::vector<LineEnd>> line_ends(std::size_t points,
                                            std::span<const std::vector<std::uint32_t>> lines);

/// The place so far along a line from one of its ends on; its other end where it is not so long.
Vec3 place_along(std::span<const Vec3> places, std::span<const std::uint32_t> line, bool back, double way);

/// Of a line, from point to point.
double length_of(std::span<const Vec3> places, std::span<const std::uint32_t> line);

}  // namespace affskel::core
