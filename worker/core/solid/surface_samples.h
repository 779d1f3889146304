#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Points spread evenly over the triangles: every triangle gets its share of the area, to one point; within a
/// triangle they follow the R2 sequence (Roberts 2018: two-dimensional golden ratio), folded over the
/// diagonal.  No randomness; only + - * / and sqrt.  A triangle's points lie on it to rounding.
/// @param count points in all, > 0.
/// @throws CoreError kBadInput when no triangle has an area.
std::vector<Vec3> surface_samples(const Mesh& mesh, std::size_t count = 50000);

/// Points spread evenly over curves: every segment gets its share of the length, to one point.
/// @throws CoreError kBadInput when no segment has a length.
std::vector<Vec3> curve_samples(std::span<const Vec3> points, std::span<const Segment> segments,
                                std::size_t count);

/// Length of all segments, mesh units.
double curve_length(std::span<const Vec3> points, std::span<const Segment> segments);

/// Area of all triangles, mesh units squared.
double surface_area(const Mesh& mesh);

}  // namespace affskel::core
