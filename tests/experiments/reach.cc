#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "client/files/read/read_shape.h"
#include "core/base/groups.h"
#include "core/base/stopwatch.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/quality/similarity.h"
#include "core/ridge/local_depth.h"
#include "core/spatial/point_index.h"
#include "curvature_skeleton.h"
#include "experiments.h"
#include "job.h"
#include "limbed_solids.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

constexpr double kPoints = 100'000, kNoise = 0.003;
constexpr double kEnd = 0.08;  // an end is the farthest place within this share of the longest side

std::vector<NamedMesh> solids_of(const Setting& setting) {
  std::vector<NamedMesh> solids;
  for (const std::string& file : setting.meshes) solids.push_back({file, client::read_shape(file).mesh()});
  if (!solids.empty()) return solids;
  if (!setting.quick) solids.push_back({"body of 5000", setting.body(5000)});
  for (NamedMesh& solid : limbed_solids(setting.quick ? 1000 : 5000)) {
    solids.push_back(std::move(solid));
    if (setting.quick && solids.size() == 2) break;
  }
  return solids;
}

// Per vertex: how far it lies from one of them along edges (Dijkstra); infinity where none lead.
std::vector<double> ways_from(std::uint32_t start, const core::Mesh& mesh,
                              const core::Groups<std::uint32_t>& beside) {
  std::vector<double> way(mesh.points.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<std::pair<double, std::uint32_t>, std::vector<std::pair<double, std::uint32_t>>,
                      std::greater<>>
      front;
  way[start] = 0;
  front.push({0, start});
  while (!front.empty()) {
    const auto [reached, at] = front.top();
    front.pop();
    if (reached > way[at]) continue;
    for (const std::uint32_t to : beside[at]) {
      const double there = reached + norm(mesh.points[to] - mesh.points[at]);
      if (there >= way[to]) continue;
      way[to] = there;
      front.push({there, to});
    }
  }
  return way;
}

// The ends of a solid: the vertices that lie farther along its surface from the place of the greatest E than all
// about them.
std::vector<core::Vec3> ends_of(const Job& job, double about) {
  const core::Mesh& mesh = job.mesh;
  const core::Groups<std::uint32_t> beside(mesh.points.size(), [&](const auto& put) {
    for (const core::Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) put(t[k], t[(k + 1) % 3]);
  });
  const Cloud all = all_points(job);
  const core::Vec3 centre = all.place[static_cast<std::size_t>(
      std::max_element(all.erosion.begin(), all.erosion.end()) - all.erosion.begin())];
  const auto nearer = [&](const core::Vec3& a, const core::Vec3& b) {
    return norm(a - centre) < norm(b - centre);
  };
  const auto start = static_cast<std::uint32_t>(
      std::min_element(mesh.points.begin(), mesh.points.end(), nearer) - mesh.points.begin());
  const std::vector<double> way = ways_from(start, mesh, beside);
  std::vector<core::Vec3> ends;
  for (std::uint32_t v = 0; v < way.size(); ++v) {
    if (!std::isfinite(way[v]) || way[v] < about) continue;
    bool farthest = true;
    for (std::uint32_t w = 0; w < way.size() && farthest; ++w)
      farthest = !(std::isfinite(way[w]) && std::pair(way[w], w) > std::pair(way[v], v) &&
                   norm(mesh.points[w] - mesh.points[v]) < about);
    if (farthest) ends.push_back(mesh.points[v]);
  }
  return ends;
}

std::vector<core::Vec3> points_along(const CurveSkeleton& skeleton, double step) {
  std::vector<core::Vec3> points = skeleton.points;
  for (const core::Segment& segment : skeleton.segments) {
    const core::Vec3 from = skeleton.points[segment[0]], way = skeleton.points[segment[1]] - from;
    const double parts = std::ceil(norm(way) / step);
    for (double n = 1; n < parts; ++n) points.push_back(from + (n / parts) * way);
  }
  return points;
}

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
  found.curve_points = points_along(found.curve, job.lattice.spacing);
  return found;
}

std::string betti(const core::BettiNumbers& b) {
  return format("%llu, %llu, %llu", static_cast<unsigned long long>(b.components),
                static_cast<unsigned long long>(b.holes), static_cast<unsigned long long>(b.cavities));
}

// What is farther from an end than its limb is thick there is short of it.
struct Reach {
  std::size_t ends = 0, short_of = 0, farther = 0;  // farther: than the curve skeleton, by a spacing
  double ridge_worst = 0, curve_worst = 0, ridge_mean = 0, curve_mean = 0;
};

Reach reach_of(const Job& job, const Skeletons& found, double longest) {
  const core::PointIndex curve(found.curve_points);
  const std::vector<float> radius = core::surface_distance(job.lattice);
  const double spacing = job.lattice.spacing;
  Reach reach;
  for (const core::Vec3& end : ends_of(job, kEnd * longest)) {
    double ridge = HUGE_VAL, allowed = 0;
    for (std::size_t v = 0; v < found.ridge.points.size(); ++v) {
      const double distance = norm(found.ridge.points.place[v] - end);
      if (distance >= ridge) continue;
      ridge = distance;
      allowed = spacing * (2 + 1.2 * static_cast<double>(radius[found.ridge.points.rank[v]]));
    }
    const double other = curve.nearest(end);
    ++reach.ends;
    reach.short_of += ridge > allowed;
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

std::string alike(std::span<const core::Vec3> clean, std::span<const core::Vec3> noisy, double radius) {
  const core::Similarity both = core::similarity(clean, noisy);
  return format("%.0f / %.0f %%", 100 * both.b_in_a.share_within(radius),
                100 * both.a_in_b.share_within(radius));
}

void study(const NamedMesh& solid, const Setting& setting, Table& reaches, Table& others, Report& report) {
  const double longest = core::box_of(solid.mesh).longest_side();
  const double volume = core::make_solid(solid.mesh).volume;
  const JobOptions options{std::cbrt(volume / (setting.quick ? 0.05 * kPoints : kPoints)), "triangles",
                           core::FrameKind::kAxis, setting.threads};
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
}

}  // namespace

void reach_experiment(const Setting& setting, Report& report) {
  report.section("The ridge beside mean curvature skeletons");
  report.text(
      "Not published: ends of the solid (the places farthest along the surface from the deepest point, among those "
      "within 8 % of the longest side), and how far from each the skeleton of `ridge` and CGAL's mean curvature "
      "skeleton (Tagliasacchi and others 2012, defaults) come. *Short* are ends that `ridge` stays farther from than "
      "1.2 local radii and two spacings; *farther* those that it stays farther from than the other does, by more than "
      "a spacing. Lengths in percent of the longest side.");
  Table reaches{
      {"solid", "ends", "short", "farther", "ridge: mean", "worst", "curvature: mean", "worst", "spacing"},
      {}};
  Table others{{"solid", "solid's topology", "ridge", "curvature", "ridge under noise of 0.3 %",
                "curvature under it", "ridge, with the field", "curvature"},
               {}};
  for (const NamedMesh& solid : solids_of(setting)) study(solid, setting, reaches, others, report);
  report.table(reaches);
  report.text(
      "Pieces, tunnels and voids; a curve has no voids. Under noise: the share within the diagonal of a voxel of 1/128 "
      "of the longest side, of the noisy one near the clean one and back.");
  report.table(others);
}

}  // namespace affskel::experiments
