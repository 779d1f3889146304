#include "core/skeleton_quality.h"

#include <algorithm>
#include <span>

#include "core/chance_level.h"
#include "core/lattice_coordinates.h"
#include "core/point_index.h"
#include "core/sheet_topology.h"
#include "core/skeleton.h"
#include "core/skeleton_advice.h"
#include "core/solid_membership.h"
#include "core/voxel_thickness.h"
#include "core/voxel_topology.h"

namespace affskel::core {
namespace {

// Inner units: far above rounding, far below anything that is seen.
constexpr double kOnSurface = 1e-12;

// Skeleton points by lattice indices (real ones for a sheet).
using Indices = std::vector<Vec3>;

std::vector<Vec3> scaled(double factor, const std::vector<Vec3>& points) {
  std::vector<Vec3> result;
  result.reserve(points.size());
  for (const Vec3& p : points) result.push_back(factor * p);
  return result;
}

std::optional<double> farthest(std::span<const Vec3> from, std::span<const Vec3> to) {
  if (from.empty() || to.empty()) return std::nullopt;
  const PointIndex index(to);
  double distance = 0;
  for (const Vec3& p : from) distance = std::max(distance, index.nearest(p));
  return distance;
}

double share_inside(const Lattice& lattice, const SolidMembership& solid, const Indices& points) {
  const auto inside = std::count_if(points.begin(), points.end(), [&](const Vec3& p) {
    return solid.contains(inner_place(lattice, p), kOnSurface);
  });
  return static_cast<double>(inside) / static_cast<double>(points.size());
}

// What does not depend on how the skeleton was found; `other` and `points` in frame coordinates.
SkeletonQuality common_part(const Solid& solid, const Lattice& lattice, const std::vector<Vec3>& points,
                            const std::vector<Vec3>& other) {
  SkeletonQuality quality;
  quality.points = points.size();
  quality.solid = betti_numbers(solid);
  if (points.empty()) return quality;
  const SolidMembership membership(solid.mesh);
  quality.inside_share = share_inside(lattice, membership, scaled(1 / lattice.spacing, points));
  quality.hausdorff_there = farthest(points, other);
  quality.hausdorff_back = farthest(other, points);
  quality.chance_level = chance_level(lattice, membership, points);
  return quality;
}

std::vector<LatticePlace> places_above(const Lattice& lattice, const std::vector<double>& divergence,
                                       double threshold) {
  std::vector<std::uint32_t> ranks;
  for (const SkeletonPoint& kept : skeleton_points(divergence, {threshold})) ranks.push_back(kept.point);
  return lattice_places(lattice, ranks);
}

std::vector<Vec3> frame_places(const Lattice& lattice, const std::vector<LatticePlace>& places) {
  std::vector<Vec3> result;
  result.reserve(places.size());
  for (const auto& [i, j, k] : places) {
    result.push_back({lattice.spacing * i, lattice.spacing * j, lattice.spacing * k});
  }
  return result;
}

// The vertices that triangles use.
std::vector<Vec3> used_vertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.points.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  std::vector<Vec3> result;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) result.push_back(mesh.points[v]);
  }
  return result;
}

}  // namespace

SkeletonQuality skeleton_quality(const Solid& solid, const Lattice& lattice, const OptimalDirections& optimal,
                                 const std::vector<double>& divergence,
                                 const SkeletonQualityOptions& options) {
  const double other_threshold = next_threshold(options.threshold);
  const std::vector<LatticePlace> places = places_above(lattice, divergence, options.threshold);
  const std::vector<LatticePlace> other = places_above(lattice, divergence, other_threshold);
  SkeletonQuality quality =
      common_part(solid, lattice, frame_places(lattice, places), frame_places(lattice, other));
  quality.skeleton = voxel_betti_numbers(places);
  quality.mean_thickness = mean_voxel_thickness(places);
  quality.other_threshold = other_threshold;
  if (places.empty()) {
    quality.advice =
        empty_skeleton_advice(lattice, optimal, divergence, options.shock_operator, options.threshold);
  }
  return quality;
}

SkeletonQuality sheet_quality(const Solid& solid, const Lattice& lattice, const Mesh& sheet,
                              const SheetQualityOptions& options) {
  const std::vector<Vec3> other = options.other ? used_vertices(*options.other) : std::vector<Vec3>{};
  SkeletonQuality quality = common_part(solid, lattice, used_vertices(sheet), other);
  quality.skeleton = sheet_topology(sheet).betti;
  quality.mean_thickness = sheet.triangles.empty() ? 0 : 1;
  quality.other_threshold = options.other_threshold;
  return quality;
}

}  // namespace affskel::core
