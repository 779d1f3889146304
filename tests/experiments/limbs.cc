#include <algorithm>
#include <cmath>

#include "core/base/stopwatch.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/quality/sheet_topology.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/point_index.h"
#include "curvature_skeleton.h"
#include "experiments.h"
#include "job.h"
#include "limb_ends.h"

namespace affskel::experiments {
namespace {

constexpr double kNoise = 0.003;

CurveSkeleton placed_curve_of(const Job& job) {
  const core::Stopwatch clock;
  const core::CurveSkeleton found = curve_of(job);
  CurveSkeleton curve;
  curve.seconds = clock.seconds();
  curve.points = places_of(job, found);
  curve.segments = found.segments;
  curve.betti = core::sheet_betti_numbers(core::mesh_of(found), found.segments);
  return curve;
}

// Largest balls in the solid about its sample points.
struct Balls {
  std::vector<core::Vec3> centre;
  std::vector<double> radius;

  Balls(const Job& job, const core::DistanceToMesh& surface) : centre(all_points(job).place) {
    for (const core::Vec3& at : centre) radius.push_back(surface.nearest(at));
  }

  // Of those that hold a place, the largest.
  double about(const core::Vec3& place, double least) const {
    for (std::size_t b = 0; b < centre.size(); ++b) {
      if (radius[b] <= least) continue;
      const core::Vec3 way = centre[b] - place;
      if (dot(way, way) <= radius[b] * radius[b]) least = radius[b];
    }
    return least;
  }
};

// How far the skeletons are from ends, and how near to the middle they run.
struct Figures {
  double mean_end = 0, worst_end = 0, mean_middle = 0, least_middle = 1;
};

Figures figures_of(const Job& job, const CurveSkeleton& curve, const std::vector<core::Vec3>& ends,
                   const Balls& balls, const core::DistanceToMesh& surface) {
  Figures figures;
  const std::vector<core::Vec3> points = points_along(curve.points, curve.segments, job.lattice.spacing);
  const core::PointIndex index(points);
  for (const core::Vec3& end : ends) {
    const double way = index.nearest(end);
    figures.mean_end += way / static_cast<double>(ends.size());
    figures.worst_end = std::max(figures.worst_end, way);
  }
  for (const core::Vec3& at : curve.points) {
    const double own = surface.nearest(at), share = own / balls.about(at, own);
    figures.mean_middle += share / static_cast<double>(curve.points.size());
    figures.least_middle = std::min(figures.least_middle, share);
  }
  return figures;
}

std::string topology_text(const core::BettiNumbers& b) {
  return format("%llu, %llu", static_cast<unsigned long long>(b.components),
                static_cast<unsigned long long>(b.holes));
}

void study(const NamedMesh& solid, const Setting& setting, Table& table, Report& report) {
  const double longest = core::box_of(solid.mesh).longest_side();
  const JobOptions options = comparison_options(solid.mesh, setting);
  const Job job = compute(solid.mesh, options);
  const core::Mesh noisy_mesh = core::perturb(solid.mesh, {kNoise * core::box_diagonal(solid.mesh), 1});
  const Job noisy = compute(noisy_mesh, options);
  const core::DistanceToMesh surface(job.mesh);
  const Balls balls(job, surface);
  const std::vector<core::Vec3> ends = ends_of_limbs(job, kLongLimb * longest);
  const double radius = std::sqrt(3.0) * longest / 128;
  const auto row = [&](const char* which, const CurveSkeleton& curve, const CurveSkeleton& other,
                       double seconds) {
    const Figures figures = figures_of(job, curve, ends, balls, surface);
    const auto points = [&](const CurveSkeleton& c) {
      return points_along(c.points, c.segments, job.lattice.spacing);
    };
    table.rows.push_back({solid.name, which, topology_text(core::betti_numbers(job.solid)),
                          topology_text(curve.betti), format("%.1f", 100 * figures.mean_end / longest),
                          format("%.1f", 100 * figures.worst_end / longest),
                          format("%.2f", figures.mean_middle), format("%.2f", figures.least_middle),
                          alike(points(curve), points(other), radius), duration(seconds)});
  };
  const CurveSkeleton ours = placed_curve_of(job), theirs = curvature_skeleton(solid.mesh);
  row("`curve`", ours, placed_curve_of(noisy), job.seconds + ours.seconds);
  row("curvature", theirs, curvature_skeleton(noisy_mesh), theirs.seconds);
  const auto more =
      static_cast<double>(ours.betti.holes) - static_cast<double>(core::betti_numbers(job.solid).holes);
  report.expect(solid.name + ": tunnels of the curve more than the solid's", more, 0, 0);
}

}  // namespace

void limbs_experiment(const Setting& setting, Report& report) {
  report.section("The curve skeleton beside mean curvature skeletons");
  report.text(
      "Not published: the skeleton of `curve` and CGAL's mean curvature skeleton (defaults). Pieces and tunnels of the "
      "solid and of each; how far from the ends of limbs they stay, in percent of the longest side; how near to the "
      "middle their vertices are: the radius of the largest ball about each over that of the largest ball in the solid "
      "that holds it; the share within the diagonal of a voxel of 1/128 of the longest side under noise of 0.3 % of the "
      "diagonal, of the noisy one near the clean one and back; and the time, that of `curve` with the field.");
  Table table{{"solid", "skeleton", "solid's topology", "topology", "ends: mean", "worst", "middle: mean",
               "least", "under noise", "time"},
              {}};
  for (const NamedMesh& solid : solids_to_compare(setting)) study(solid, setting, table, report);
  report.table(table);
}

}  // namespace affskel::experiments
