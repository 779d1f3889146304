#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <utility>

#include "client/files/read/read_shape.h"
#include "core/base/disjoint_sets.h"
#include "core/base/groups.h"
#include "core/base/stopwatch.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/quality/similarity.h"
#include "core/ridge/local_depth.h"
#include "core/ridge/ridge_constants.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/point_index.h"
#include "curvature_skeleton.h"
#include "experiments.h"
#include "job.h"
#include "limbed_solids.h"
#include "sheet.h"

namespace affskel::experiments {
namespace {

constexpr double kPoints = 100'000, kNoise = 0.003;
constexpr double kEnd = 0.08;  // a limb is longer than this share of the longest side

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

using Neighbours = core::Groups<std::uint32_t>;

// Per vertex: how far it lies from one of them along edges (Dijkstra); infinity where none lead.
std::vector<double> ways_from(std::uint32_t start, const core::Mesh& mesh, const Neighbours& beside) {
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

// The same surface in more triangles: along the edges of few the ways turn, and ends arise where none are.
core::Mesh refined(core::Mesh mesh) {
  constexpr std::size_t kTriangles = 20'000;
  while (mesh.triangles.size() < kTriangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;  // of edges
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const auto [known, fresh] =
          middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.points.size()));
      if (fresh) mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
      return known->second;
    };
    std::vector<core::Triangle> four;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
      four.insert(four.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(four);
  }
  return mesh;
}

// Where a height on the vertices of a mesh is greatest, and falls by `least` at least before it rises to a greater one
// (persistence: Edelsbrunner, Letscher and Zomorodian 2002).
std::vector<std::uint32_t> peaks(const std::vector<double>& height, const Neighbours& beside, double least) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < height.size(); ++v)
    if (std::isfinite(height[v])) order.push_back(v);
  const auto higher = [&](std::uint32_t a, std::uint32_t b) { return height[a] > height[b]; };
  std::stable_sort(order.begin(), order.end(), higher);
  std::vector<std::uint32_t> found{order.front()};
  core::DisjointSets pieces(height.size());  // of what is higher
  std::vector<std::uint32_t> top(height.size());
  std::iota(top.begin(), top.end(), 0U);
  for (const std::uint32_t v : order) {
    for (const std::uint32_t w : beside[v]) {
      if (height[w] < height[v]) continue;
      std::uint32_t a = top[pieces.find(v)], b = top[pieces.find(w)];
      if (!pieces.unite(v, w)) continue;
      if (higher(b, a)) std::swap(a, b);
      top[pieces.find(v)] = a;
      if (height[b] - height[v] >= least) found.push_back(b);
    }
  }
  return found;
}

// The ends of limbs longer than `length`: peaks of the way along the surface from the place of the greatest E.  The
// crotch, the back and the calves are none.
std::vector<core::Vec3> ends_of(const Job& job, double length) {
  const core::Mesh mesh = refined(job.mesh);
  const Neighbours beside(mesh.points.size(), [&](const auto& put) {
    for (const core::Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) put(t[k], t[(k + 1) % 3]);
  });
  const Cloud all = all_points(job);
  const core::Vec3 centre = all.place[static_cast<std::size_t>(
      std::max_element(all.erosion.begin(), all.erosion.end()) - all.erosion.begin())];
  const std::uint32_t start = core::PointIndex(mesh.points).find(centre).number;
  std::vector<core::Vec3> ends;
  for (const std::uint32_t v : peaks(ways_from(start, mesh, beside), beside, length))
    ends.push_back(mesh.points[v]);
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
    if (radius[all.rank[p]] >= core::RidgeConstants{}.min_radius) places.push_back(all.place[p]);
  return core::PointIndex(places);
}

Reach reach_of(const Job& job, const Skeletons& found, double longest) {
  const core::PointIndex curve(found.curve_points), resolved = resolved_places(job);
  const core::DistanceToMesh surface(job.mesh);
  const double spacing = job.lattice.spacing;
  Reach reach;
  for (const core::Vec3& end : ends_of(job, kEnd * longest)) {
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
  for (const NamedMesh& solid : solids_of(setting)) study(solid, setting, reaches, others, report);
  report.table(reaches);
  report.text(
      "Pieces, tunnels and voids; a curve has no voids. Under noise: the share within the diagonal of a voxel of 1/128 "
      "of the longest side, of the noisy one near the clean one and back.");
  report.table(others);
}

}  // namespace affskel::experiments
