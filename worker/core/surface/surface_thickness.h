#pragma once

#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

struct ThicknessOptions {
  double near = 0;       ///< that near, the skeleton is reached: scaled units, > 0; half a spacing
  unsigned threads = 1;  ///< >= 1; the result does not depend on it
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// How thick the solid is under each triangle of its surface: from its centroid along the optimal normal, within the solid,
/// to where that way comes nearest to the skeleton.  In hollows the optimal plane is that of another side, and the normal may
/// lead out of the solid: then the other way.  Where it passes the skeleton at more than half of the centroid's distance, and
/// leaves the solid, there is no skeleton under the triangle, as in a bent wall, which has no ridge: half of that way, unless
/// it is steep to the surface.  Else the distance to the skeleton.  Where it is more than kMostThick times as thick as the solid
/// is about there, as at the rim of a wall, from which the way leads along it, it counts as that.
/// @param surface of the solid, divided as may be; scaled coordinates.
/// @param skeleton scaled coordinates; its curves as triangles of two different corners, one vertex as one of one.
/// @param inward per triangle of the surface: the optimal normal, unit, or 0 where there is none.
/// @param about per triangle of the surface: how thick the solid is there, see local_thickness(); scaled units, may be infinite.
/// @return per triangle, scaled units.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<double> surface_thickness(const Solid& solid, const Mesh& surface, const Mesh& skeleton,
                                      std::span<const Vec3> inward, std::span<const double> about,
                                      const ThicknessOptions& options);

inline constexpr double kMostThick = 1.5;

}  // namespace affskel::core
