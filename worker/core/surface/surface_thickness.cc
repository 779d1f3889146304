#include "core/surface/surface_thickness.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/unit.h"
#include "core/solid/solid_membership.h"
#include "core/spatial/box_tree.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/ray_crossing.h"

namespace affskel::core {
namespace {

// A step is a share of the distance to the skeleton, which it cannot cross so (Hart, "Sphere tracing", 1996); by less
// than 1 the least distance is not passed over where the way misses a curve.
constexpr double kStep = 0.5;
constexpr double kSlack = 1e-9;  // for rounding, of ways
constexpr double kPasses = 0.5;  // of the centroid's distance: see surface_thickness()
constexpr double kFacing =
    0.75;  // cosine: a way that is steeper to the surface does not tell how thick a wall is

class Ways {
 public:
  Ways(const Solid& solid, const Mesh& skeleton, const ThicknessOptions& options)
      : solid_(solid.mesh),
        triangles_(boxes_of(solid.mesh), options.threads),
        membership_(solid.mesh),
        skeleton_(skeleton),
        near_(options.near) {}

  // @param normal of the surface there, unit, towards the inside.
  double thickness(const Vec3& from, const Vec3& optimal, const Vec3& normal) const {
    const double facing = dot(optimal, normal);
    const Vec3 inward = facing < 0 ? -optimal : optimal;
    const Vec3 nearest = skeleton_.nearest_place(from);
    const double straight = norm(nearest - from);
    if (dot(inward, inward) == 0 || straight <= near_) return straight;
    double least = straight, foot = dot(nearest - from, inward);
    const double most = way_out(from, inward, 2 * straight);
    for (double way = std::max(kStep * straight, near_); least > near_ && way < most;) {
      const Vec3 at = from + way * inward;
      const Vec3 there = skeleton_.nearest_place(at);
      const double distance = norm(there - at);
      if (distance < least) {
        least = distance;
        foot = dot(there - from, inward);
      }
      way += std::max(kStep * distance, near_);
    }
    if (least <= std::max(near_, kPasses * straight) && foot > 0) return foot;
    const bool is_wall = most > 0 && most < 2 * straight && std::abs(facing) > kFacing;
    return is_wall ? 0.5 * most : straight;
  }

 private:
  // How far a way from the surface is within the solid, at most `most`: by how often the surface winds round its far end, and
  // what it crosses before.
  double way_out(const Vec3& from, const Vec3& inward, double most) const {
    const double slack = kSlack * most;  // what it begins on, with its neighbours, is not crossed
    const CrossedLine line(from, inward);
    std::vector<std::pair<double, int>> crossings;
    int winding = membership_.winding_number(from + most * inward);
    triangles_.visit(WayQuery{from, inward, slack, most}, [&](std::uint32_t t) {
      const auto crossing = line.with(solid_, solid_.triangles[t]);
      if (!crossing || !(crossing->part > slack && crossing->part <= most)) return;
      crossings.emplace_back(crossing->part, crossing->leaves);
      winding += crossing->leaves;
    });
    if (winding <= 0) return 0;
    std::sort(crossings.begin(), crossings.end());
    for (auto at = crossings.begin(); at != crossings.end();) {
      const double way = at->first;  // where solids touch, the way goes on
      for (; at != crossings.end() && at->first <= way + slack; ++at) winding -= at->second;
      if (winding <= 0) return way;
    }
    return most;
  }

  const Mesh& solid_;
  BoxTree triangles_;
  SolidMembership membership_;
  DistanceToMesh skeleton_;
  double near_;
};

}  // namespace

std::vector<double> surface_thickness(const Solid& solid, const Mesh& surface, const Mesh& skeleton,
                                      std::span<const Vec3> inward, std::span<const double> about,
                                      const ThicknessOptions& options) {
  const Ways ways(solid, skeleton, options);
  std::vector<double> result(surface.triangles.size());
  parallel_ranges(options.threads, result.size(), [&](std::size_t begin, std::size_t end) {
    StopCheck stop(options.context);
    for (std::size_t t = begin; t < end; ++t, stop.did(1000)) {
      const auto& [a, b, c] = surface.triangles[t];
      const auto& points = surface.points;
      const Vec3 normal = -1.0 * unit(twice_area(surface, surface.triangles[t]));
      const double way = ways.thickness((1.0 / 3) * (points[a] + (points[b] + points[c])), inward[t], normal);
      // By sample points, which are half a spacing off.
      result[t] = way > kMostThick * (about[t] + options.near) ? about[t] : way;
    }
  });
  return result;
}

}  // namespace affskel::core
