#include "limb_ends.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <queue>
#include <utility>

#include "client/files/read/read_shape.h"
#include "core/base/disjoint_sets.h"
#include "core/base/groups.h"
#include "core/erosion/frame_field.h"
#include "core/quality/similarity.h"
#include "core/ridge/ridge_sheet.h"
#include "core/spatial/point_index.h"

namespace affskel::experiments {
namespace {

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

// Whether a peak is no far side of a ring: going down, the piece about it stays a disc until it meets that of a higher
// one, or goes down by more than so many radii of a circle as long as its rim.  A half ball goes down by 1.6.
bool is_end(std::uint32_t peak, const std::vector<double>& way, const core::Mesh& mesh,
            const Neighbours& beside) {
  constexpr double kRadii = 1.7;
  constexpr int kLevels = 48;
  std::vector<char> in(way.size(), 0);
  std::vector<std::uint32_t> front{peak},
      next;  // what was reached last, and what lies below the level beside the piece
  in[peak] = 1;
  for (int k = 1; k < kLevels; ++k) {
    const double level = way[peak] * (1 - static_cast<double>(k) / kLevels);
    next.clear();
    while (!front.empty()) {
      const std::uint32_t at = front.back();
      front.pop_back();
      if (way[at] > way[peak]) return true;
      for (const std::uint32_t to : beside[at]) {
        if (in[to]) continue;
        if (way[to] < level) {
          next.push_back(at);
        } else {
          in[to] = 1;
          front.push_back(to);
        }
      }
    }
    front = next;
    std::int64_t euler = std::count(in.begin(), in.end(), 1);
    double rim = 0, edges = 0;  // every edge of a closed surface is met twice
    for (const core::Triangle& corners : mesh.triangles) {
      std::vector<core::Vec3> crossings;
      int inside = 0;
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t a = corners[e], b = corners[(e + 1) % 3];
        inside += in[a];
        edges += in[a] && in[b] ? 0.5 : 0;
        if (in[a] != in[b])
          crossings.push_back(mesh.points[a] +
                              (level - way[a]) / (way[b] - way[a]) * (mesh.points[b] - mesh.points[a]));
      }
      euler += inside == 3 ? 1 : 0;
      if (crossings.size() == 2) rim += norm(crossings[0] - crossings[1]);
    }
    if (euler - std::llround(edges) != 1) return false;
    if (way[peak] - level >= kRadii * rim / (2 * std::numbers::pi)) return true;
  }
  return true;
}

}  // namespace

std::vector<core::Vec3> ends_of_limbs(const Job& job, double length) {
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
  const std::vector<double> way = ways_from(start, mesh, beside);
  for (const std::uint32_t v : peaks(way, beside, length))
    if (is_end(v, way, mesh, beside)) ends.push_back(mesh.points[v]);
  return ends;
}

std::vector<NamedMesh> solids_to_compare(const Setting& setting) {
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

std::vector<NamedMesh> bodies_to_compare(const Setting& setting) {
  std::vector<NamedMesh> bodies;
  for (const std::string& file : setting.meshes) bodies.push_back({file, client::read_shape(file).mesh()});
  if (!bodies.empty()) return bodies;
  for (const std::uint32_t triangles :
       setting.quick ? std::vector<std::uint32_t>{292} : std::vector<std::uint32_t>{292, 1000, 5000})
    bodies.push_back({format("body of %u", triangles), setting.body(triangles)});
  if (!setting.quick) bodies.push_back({"heavy body of 500", setting.heavy_body()});
  return bodies;
}

JobOptions comparison_options(const core::Mesh& mesh, const Setting& setting) {
  const double points = setting.quick ? 5'000 : 100'000;
  return {std::cbrt(core::make_solid(mesh).volume / points), "triangles", core::FrameKind::kAxis,
          setting.threads};
}

std::vector<core::Vec3> points_along(std::span<const core::Vec3> places,
                                     std::span<const core::Segment> segments, double step) {
  std::vector<core::Vec3> points(places.begin(), places.end());
  for (const core::Segment& segment : segments) {
    const core::Vec3 from = places[segment[0]], way = places[segment[1]] - from;
    const double parts = std::ceil(norm(way) / step);
    for (double n = 1; n < parts; ++n) points.push_back(from + (n / parts) * way);
  }
  return points;
}

std::string alike(std::span<const core::Vec3> clean, std::span<const core::Vec3> noisy, double radius) {
  const core::Similarity both = core::similarity(clean, noisy);
  return format("%.0f / %.0f %%", 100 * both.b_in_a.share_within(radius),
                100 * both.a_in_b.share_within(radius));
}

core::CurveSkeleton curve_of(const Job& job, const core::CurveOptions& options) {
  const core::FrameField field = core::frame_field(job.lattice, job.directions, job.values);
  const core::RidgeBasis basis = core::ridge_basis(job.solid, job.lattice, field);
  const core::RidgeSheet ridge = core::ridge_sheet(job.solid, job.lattice, field, basis);
  const core::LimbSurface surface = core::limb_surface(job.solid, job.lattice);
  return core::curve_skeleton({job.solid, job.lattice, basis, ridge, surface}, options);
}

std::vector<core::Vec3> places_of(const Job& job, const core::SheetMesh& skeleton) {
  const core::Vec3 origin = core::SamplePlaces(job.solid, job.lattice).origin();
  const core::Matrix3 frame = core::frame_matrix(job.lattice);
  std::vector<core::Vec3> places;
  for (const core::SheetVertex& vertex : skeleton.vertices)
    places.push_back(origin + frame * vertex.position);
  return places;
}

}  // namespace affskel::experiments
