// The affine skeleton beside medial ones under noise, maps and remeshing: which shares of each stay where they were.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/affine_map.h"
#include "core/mesh/box.h"
#include "core/mesh/map_mesh.h"
#include "core/mesh/perturb.h"
#include "core/quality/interior_points.h"
#include "core/quality/similarity.h"
#include "core/solid/surface_samples.h"
#include "curvature_skeleton.h"
#include "experiments.h"
#include "job.h"
#include "sheet.h"
#include "voronoi_axis.h"

namespace affskel::experiments {
namespace {

using Points = std::vector<core::Vec3>;

constexpr std::size_t kSurfacePoints = 20000;  // over a sheet, and of the surface for poles
constexpr std::size_t kCurvePoints = 4000;     // over curves

// Of one mesh, spread evenly where they have an extent.
struct Skeletons {
  Points ridge, poles, curvature;
};

Points points_of(const Sheet& sheet) {
  Points points;
  if (!sheet.mesh.triangles.empty()) points = core::surface_samples(sheet.mesh, kSurfacePoints);
  if (sheet.segments.empty()) return points;
  const Points curves = core::curve_samples(sheet.mesh.points, sheet.segments, kCurvePoints);
  points.insert(points.end(), curves.begin(), curves.end());
  return points;
}

Skeletons skeletons_of(const core::Mesh& mesh, const JobOptions& options) {
  const CurveSkeleton curvature = curvature_skeleton(mesh);
  return {points_of(ridge_sheet_of(compute(mesh, options))), inner_poles(mesh, kSurfacePoints),
          core::curve_samples(curvature.points, curvature.segments, kCurvePoints)};
}

Points mapped(const core::AffineMap& map, Points points) {
  for (core::Vec3& p : points) p = map(p);
  return points;
}

// What is done to a mesh, and where its skeletons should be then.
struct Change {
  std::string name;
  core::Mesh mesh;
  core::AffineMap map;
};

std::vector<Change> changes(const core::Mesh& body) {
  const double diagonal = core::box_diagonal(body);
  const core::AffineMap shear = core::shear(0, 2, 0.5);
  return {{"noise of 0.1 % of the diagonal", core::perturb(body, {.sigma = 0.001 * diagonal}), {}},
          {"noise of 0.3 %", core::perturb(body, {.sigma = 0.003 * diagonal}), {}},
          {"noise of 1 %", core::perturb(body, {.sigma = 0.01 * diagonal}), {}},
          {"shear by a half", core::map_mesh(shear, body), shear},
          {"remeshed isotropically", remeshed_isotropically(body), {}}};
}

void compare(const Setting& setting, std::uint32_t triangles, Report& report) {
  const core::Mesh& body = setting.body(triangles);
  const JobOptions options{setting.spacing(), "triangles+sphere:2000", core::FrameKind::kAffine,
                           setting.threads};
  const Skeletons clean = skeletons_of(body, options);
  const double radius = std::sqrt(3.0) * options.spacing;
  const auto alike = [&](const Points& was, const Points& is) {
    const core::Similarity s = core::similarity(was, is);
    return std::array{s.b_in_a.share_within(radius), s.a_in_b.share_within(radius)};
  };
  const auto text = [](const std::array<double, 2>& shares) {
    return format("%.1f / %.1f", 100 * shares[0], 100 * shares[1]);
  };
  const Points inside = core::interior_points(core::make_solid(body));
  const auto chance = [&](const Points& skeleton) {
    return core::DistanceCurve(inside, skeleton).share_within(radius);
  };
  const double chance_of_ridge = chance(clean.ridge), chance_of_poles = chance(clean.poles);
  Table table{{format("body of %u", triangles), "`ridge`", "inner poles", "curvature skeleton"}, {}};
  for (const Change& change : changes(body)) {
    const Skeletons now = skeletons_of(change.mesh, options);
    const auto ridge = alike(mapped(change.map, clean.ridge), now.ridge);
    const auto poles = alike(mapped(change.map, clean.poles), now.poles);
    table.rows.push_back({change.name, text(ridge), text(poles),
                          text(alike(mapped(change.map, clean.curvature), now.curvature))});
    report.expect(format("body of %u, %s: lesser share beyond chance, of the ridge less that of the poles",
                         triangles, change.name.c_str()),
                  std::ranges::min(ridge) - chance_of_ridge - (std::ranges::min(poles) - chance_of_poles), 0,
                  1);
  }
  table.rows.push_back({"chance", format("%.0f", 100 * chance_of_ridge),
                        format("%.0f", 100 * chance_of_poles),
                        format("%.0f", 100 * chance(clean.curvature))});
  report.table(table);
}

}  // namespace

void medial_experiment(const Setting& setting, Report& report) {
  report.section("Beside medial skeletons");
  report.text(
      "Not published. Of each skeleton the share that lies within a voxel's diagonal of where it was, there and back, "
      "in percent: `ridge` in the affine frame, the inner poles of 20,000 samples of the surface, which are vertices "
      "of its Voronoi diagram and near the medial axis (Amenta, Choi and Kolluri 2001), and CGAL's mean curvature "
      "skeleton. Chance: the share of the solid's inside that near to the skeleton; poles that lie everywhere are alike "
      "by chance.");
  for (const std::uint32_t triangles :
       setting.quick ? std::vector<std::uint32_t>{292} : std::vector<std::uint32_t>{292, 1000, 5000})
    compare(setting, triangles, report);
}

}  // namespace affskel::experiments
