#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/stopwatch.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/ridge/local_depth.h"
#include "core/ridge/ridge_constants.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/point_index.h"
#include "curvature_skeleton.h"
#include "experiments.h"
#include "job.h"
#include "limb_ends.h"
#include "limbed_solids.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

constexpr double kNoise = 0.003;

struct Skeletons {
  Sheet ridge;
  CurveSkeleton curve;
  std::vector<core::Vec3> curve_points;
  double ridge_seconds = 0;  // without the field
};

Skeletons skeletons_of(const Job& job) {
  Skeletons found;
  const core::Stopwatch clock;
  found.ridge = ridge_sheet_of(job);
  found.ridge_seconds = clock.seconds();
  found.curve = curvature_skeleton(job.mesh);
  found.curve_points = points_along(found.curve.points, found.curve.segments, job.lattice.spacing);
  return found;
}

std::string betti(const core::BettiNumbers& b) {
  return format("%llu, %llu, %llu", static_cast<unsigned long long>(b.components),
                static_cast<unsigned long long>(b.holes), static_cast<unsigned long long>(b.cavities));
}

// What is farther from an end than its limb is thick there is short of it, unless the lattice has no point four across
// that is nearer.
struct Reach {
  std::size_t ends = 0, short_of = 0, farther = 0;  // farther: than the curve skeleton, by a spacing
  double ridge_worst = 0, curve_worst = 0, ridge_mean = 0, curve_mean = 0;
};

core::PointIndex resolved_places(const Job& job) {
  const std::vector<float> radius = core::surface_distance(job.lattice);
  const Cloud all = all_points(job);
  std::vector<core::Vec3> places;
  for (std::size_t p = 0; p < all.size(); ++p)
    if (radius[all.rank[p]] >= core::RidgeConstants::min_radius) places.push_back(all.place[p]);
  return core::PointIndex(places);
}

Reach reach_of(const Job& job, const Skeletons& found, double longest) {
  const core::PointIndex curve(found.curve_points), resolved = resolved_places(job);
  const core::DistanceToMesh surface(job.mesh);
  const double spacing = job.lattice.spacing;
  Reach reach;
  for (const core::Vec3& end : ends_of_limbs(job, kLongLimb * longest)) {
    const auto nearer = [&](const core::Vec3& a, const core::Vec3& b) {
      return norm(a - end) < norm(b - end);
    };
    const auto& places = found.ridge.points.place;
    const core::Vec3 nearest = *std::min_element(places.begin(), places.end(), nearer);
    const double ridge = norm(nearest - end), other = curve.nearest(end);
    const double allowed = 1.2 * surface.nearest(nearest) + 2 * spacing;
    ++reach.ends;
    reach.short_of += ridge > std::max(allowed, resolved.nearest(end));
    reach.farther += ridge > other + spacing;
    reach.ridge_worst = std::max(reach.ridge_worst, ridge);
    reach.curve_worst = std::max(reach.curve_worst, other);
    reach.ridge_mean += ridge;
    reach.curve_mean += other;
  }
  const double count = std::max<double>(1, static_cast<double>(reach.ends));
  reach.ridge_mean /= count;
  reach.curve_mean /= count;
  return reach;
}

void study(const NamedMesh& solid, const Setting& setting, Table& reaches, Table& others, Report& report) {
  const double longest = core::box_of(solid.mesh).longest_side();
  const JobOptions options = comparison_options(solid.mesh, setting);
  const Job job = compute(solid.mesh, options);
  const Skeletons found = skeletons_of(job);
  const Reach reach = reach_of(job, found, longest);
  const auto share = [&](double length) { return format("%.1f", 100 * length / longest); };
  reaches.rows.push_back({solid.name, std::to_string(reach.ends), std::to_string(reach.short_of),
                          std::to_string(reach.farther), share(reach.ridge_mean), share(reach.ridge_worst),
                          share(reach.curve_mean), share(reach.curve_worst), share(job.lattice.spacing)});
  const double diagonal = core::box_diagonal(solid.mesh), radius = std::sqrt(3.0) * longest / 128;
  const Job noisy = compute(core::perturb(solid.mesh, {kNoise * diagonal, 1}), options);
  const Skeletons other = skeletons_of(noisy);
  others.rows.push_back({solid.name, betti(core::betti_numbers(job.solid)), betti(found.ridge.betti),
                         betti(found.curve.betti),
                         alike(found.ridge.points.place, other.ridge.points.place, radius),
                         alike(found.curve_points, other.curve_points, radius),
                         duration(job.seconds + found.ridge_seconds), duration(found.curve.seconds)});
  report.expect(solid.name + ": pieces of the ridge more than the solid's",
                static_cast<double>(found.ridge.betti.components) -
                    static_cast<double>(core::betti_numbers(job.solid).components),
                0, 0);
  report.expect(solid.name + ": ends that the ridge is short of", static_cast<double>(reach.short_of), 0, 0);
  // The other's differs from run to run.
  report.expect(solid.name + ": ends that the other comes nearer to by more than a spacing",
                static_cast<double>(reach.farther), 0, 1);
}

}  // namespace

void reach_experiment(const Setting& setting, Report& report) {
  report.section("The ridge beside mean curvature skeletons");
  report.text(
      "Not published: ends of the solid (of limbs longer than 8 % of the longest side: peaks of that persistence of "
      "the way along the surface from the deepest point), and how far from each the skeleton of `ridge` and CGAL's "
      "mean curvature skeleton (Tagliasacchi and others 2012, defaults) come. *Short* are ends that `ridge` stays "
      "farther from than 1.2 local radii and two spacings, and than the nearest sample point that lies four points "
      "across; *farther* those that it stays farther from than the other does, by more than a spacing. Lengths in "
      "percent of the longest side.");
  Table reaches{
      {"solid", "ends", "short", "farther", "ridge: mean", "worst", "curvature: mean", "worst", "spacing"},
      {}};
  Table others{{"solid", "solid's topology", "ridge", "curvature", "ridge under noise of 0.3 %",
                "curvature under it", "ridge, with the field", "curvature"},
               {}};
  for (const NamedMesh& solid : solids_to_compare(setting)) study(solid, setting, reaches, others, report);
  report.table(reaches);
  report.text(
      "Pieces, tunnels and voids; a curve has no voids. Under noise: the share within the diagonal of a voxel of 1/128 "
      "of the longest side, of the noisy one near the clean one and back.");
  report.table(others);
}

}  // namespace affskel::experiments
