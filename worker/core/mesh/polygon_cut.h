#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Ears are clipped of polygons with up to so many corners.
inline constexpr std::size_t kMaxEarCorners = 8192;

/// How far a polygon is from being plane.
struct Unevenness {
  double distance = 0;  ///< of the farthest corner from the plane through the corners' mean along their area
  double volume =
      0;  ///< between two ways of cutting it: of a quadrilateral that of its corners' tetrahedron, of a
          ///< larger one at most about its area times the distance
};

/// @param corners >= 3, indices into points.
Unevenness unevenness(std::span<const Vec3> points, std::span<const std::uint32_t> corners);

/// Cuts one polygon (>= 3 corners, indices into points) into corners.size() - 2 triangles of the same
/// sense and appends them.  Quadrilaterals along the diagonal that leaves both halves facing the
/// polygon's way, the shorter one if both do; larger ones by clipping ears in the plane of the area
/// vector (Meisters 1975), so that planar polygons with reflex corners do not fold over, nor those with holes that a
/// bridge leads to and back from, whether its ends are named or stand in `points` twice; a fan where no ear is left
/// (polygons that cross themselves) and above kMaxEarCorners.  Takes time in the order of the corners times those that
/// are reflex: a third of a second at most.
void cut_polygon(std::span<const Vec3> points, std::span<const std::uint32_t> corners,
                 std::vector<Triangle>& out);

}  // namespace affskel::core
