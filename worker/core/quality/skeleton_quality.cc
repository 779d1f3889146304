#include "core/quality/skeleton_quality.h"

#include <algorithm>
#include <iterator>

#include "core/lattice/lattice_coordinates.h"
#include "core/quality/chance_level.h"
#include "core/quality/sheet_topology.h"
#include "core/quality/similarity.h"
#include "core/quality/skeleton_advice.h"
#include "core/quality/voxel_thickness.h"
#include "core/quality/voxel_topology.h"
#include "core/shocks/skeleton.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

// Tolerance in scaled units: far above rounding, far below anything that can be seen.
constexpr double kOnSurface = 1e-12;

std::optional<double> farthest(std::span<const Vec3> from, std::span<const Vec3> to) {
  if (from.empty() || to.empty()) return std::nullopt;
  return DistanceCurve(from, to).hausdorff();
}

double share_inside(const Lattice& lattice, const SolidMembership& solid, const std::vector<Vec3>& points) {
  const double steps = 1 / lattice.spacing;
  const auto inside = std::count_if(points.begin(), points.end(), [&](const Vec3& p) {
    return solid.contains(scaled_place(lattice, steps * p), kOnSurface);
  });
  return static_cast<double>(inside) / static_cast<double>(points.size());
}

// What does not depend on how the skeleton was found; points in frame coordinates.
SkeletonQuality common_part(const Solid& solid, const Lattice& lattice, const std::vector<Vec3>& points) {
  SkeletonQuality quality;
  quality.points = points.size();
  quality.solid = betti_numbers(solid);
  if (points.empty()) return quality;
  const SolidMembership membership(solid.mesh);
  quality.inside_share = share_inside(lattice, membership, points);
  quality.chance_level = chance_level(lattice, membership, points);
  return quality;
}

std::vector<LatticePlace> places_above(const Lattice& lattice, const std::vector<double>& divergence,
                                       double threshold) {
  std::vector<std::uint32_t> ranks;
  for (const SkeletonPoint& kept : skeleton_points(divergence, threshold)) ranks.push_back(kept.point);
  return lattice_places(lattice, ranks);
}

std::vector<Vec3> frame_places(const Lattice& lattice, const std::vector<LatticePlace>& places) {
  std::vector<Vec3> result;
  result.reserve(places.size());
  for (const LatticePlace& place : places) result.push_back(lattice.spacing * vector_of(place));
  return result;
}

// `other` is a subset of `places`, so only points that it lacks have a distance > 0 from it.
void add_distances(const Lattice& lattice, const std::vector<LatticePlace>& places,
                   const std::vector<LatticePlace>& other, SkeletonQuality& quality) {
  if (other.empty()) return;
  std::vector<LatticePlace> lacking;
  std::set_difference(places.begin(), places.end(), other.begin(), other.end(), std::back_inserter(lacking));
  quality.hausdorff_there =
      farthest(frame_places(lattice, lacking), frame_places(lattice, other)).value_or(0);
  quality.hausdorff_back = 0;
}

}  // namespace

SkeletonQuality skeleton_quality(const Solid& solid, const Lattice& lattice, const OptimalDirections& optimal,
                                 const std::vector<double>& divergence,
                                 const SkeletonQualityOptions& options) {
  const double other_threshold = next_threshold(options.threshold);
  const std::vector<LatticePlace> places = places_above(lattice, divergence, options.threshold);
  const std::vector<LatticePlace> other = places_above(lattice, divergence, other_threshold);
  SkeletonQuality quality = common_part(solid, lattice, frame_places(lattice, places));
  add_distances(lattice, places, other, quality);
  quality.skeleton = voxel_betti_numbers(places);
  quality.mean_thickness = mean_voxel_thickness(places);
  quality.other_threshold = other_threshold;
  if (places.empty()) {
    quality.advice = empty_skeleton_advice(lattice, optimal, divergence, options.shock_operator,
                                           options.threshold, options.more_directions);
  }
  return quality;
}

SkeletonQuality sheet_quality(const Solid& solid, const Lattice& lattice, const Mesh& sheet,
                              const SheetQualityOptions& options) {
  SkeletonQuality quality =
      common_part(solid, lattice, options.points != nullptr ? *options.points : sheet.points);
  if (options.other != nullptr) {
    quality.hausdorff_there = farthest(sheet.points, options.other->points);
    quality.hausdorff_back = farthest(options.other->points, sheet.points);
  }
  quality.skeleton = sheet_betti_numbers(sheet, options.segments);
  quality.mean_thickness = sheet.points.empty() ? 0 : 1;
  quality.other_threshold = options.other_threshold;
  if (quality.points == 0) quality.advice = options.advice_if_empty;
  return quality;
}

}  // namespace affskel::core
