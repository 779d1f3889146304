#include "core/surface/surface_thickness.h"

#include <algorithm>
#include <cstddef>

#include "core/base/parallel.h"
#include "core/solid/solid_membership.h"
#include "core/spatial/distance_to_mesh.h"

namespace affskel::core {
namespace {

// A step is a share of the distance to the skeleton, which it cannot cross so (Hart, "Sphere tracing", 1996); by less
// than 1 the least distance is not passed over where the way misses a curve.
constexpr double kStep = 0.5;
constexpr double kPasses = 0.5;  // of the centroid's distance: see surface_thickness()

class Ways {
 public:
  Ways(const Solid& solid, const Mesh& skeleton, double near)
      : skeleton_(skeleton), membership_(solid.mesh), near_(near) {}

  double thickness(const Vec3& from, const Vec3& inward) const {
    const Vec3 nearest = skeleton_.nearest_place(from);
    const double straight = norm(nearest - from);
    if (dot(inward, inward) == 0) return straight;
    double least = straight, foot = dot(nearest - from, inward);
    for (double way = std::max(kStep * straight, near_); least > near_ && way < 2 * straight;) {
      const Vec3 at = from + way * inward;
      if (!membership_.contains(at)) break;
      const Vec3 there = skeleton_.nearest_place(at);
      const double distance = norm(there - at);
      if (distance < least) {
        least = distance;
        foot = dot(there - from, inward);
      }
      way += std::max(kStep * distance, near_);
    }
    return least <= std::max(near_, kPasses * straight) && foot > 0 ? foot : straight;
  }

 private:
  DistanceToMesh skeleton_;
  SolidMembership membership_;
  double near_;
};

}  // namespace

std::vector<double> surface_thickness(const Solid& solid, const Mesh& surface, const Mesh& skeleton,
                                      std::span<const Vec3> inward, const ThicknessOptions& options) {
  const Ways ways(solid, skeleton, options.near);
  std::vector<double> result(surface.triangles.size());
  parallel_ranges(options.threads, result.size(), [&](std::size_t begin, std::size_t end) {
    StopCheck stop(options.context);
    for (std::size_t t = begin; t < end; ++t, stop.did(1000)) {
      const auto& [a, b, c] = surface.triangles[t];
      const auto& points = surface.points;
      result[t] = ways.thickness((1.0 / 3) * (points[a] + (points[b] + points[c])), inward[t]);
    }
  });
  return result;
}

}  // namespace affskel::core
