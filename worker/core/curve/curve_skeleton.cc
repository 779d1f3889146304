#include "core/curve/curve_skeleton.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "core/base/cheapest_ways.h"
#include "core/base/groups.h"
#include "core/base/require.h"
#include "core/contour/edge_cells.h"
#include "core/curve/sheet_lines.h"
#include "core/curve/volume_beyond.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/polylines.h"
#include "core/solid/solid_membership.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/point_index.h"

namespace affskel::core {
namespace {

// Each pass is a step to the mean of the neighbours and a longer one back: what is shorter than about fifteen
// segments goes, what is longer stays.
constexpr int kPasses = 300;
constexpr double kStep = 0.5, kStepBack = -0.51;

// A tip that the ridge reaches lies no farther from it than half its limb's width and so many spacings.
constexpr double kNearTip = 2;

// Which vertices of the ridge are the ends of limbs, and where the tips of these are, frame coordinates.
struct LimbEnds {
  std::vector<char> is_end;
  std::vector<Vec3> tip;
};

LimbEnds ends_of_limbs(const Lattice& lattice, const RidgeBasis& basis, const RidgeSheet& ridge,
                       double least_reach) {
  LimbEnds ends{std::vector<char>(ridge.vertices.size(), 0), std::vector<Vec3>(ridge.vertices.size())};
  std::vector<Vec3> places;
  for (const SheetVertex& vertex : ridge.vertices) places.push_back(vertex.position);
  const PointIndex index(places);
  std::vector<LimbTip> limbs = basis.limbs;
  limbs.insert(limbs.end(), ridge.filled.limbs.begin(), ridge.filled.limbs.end());
  std::vector<DualComplex::Cell> tips;
  for (const LimbTip& limb : limbs) tips.push_back(limb.vertex);
  std::sort(tips.begin(), tips.end());
  const std::vector<CellPlace> cells = cells_of_vertices(lattice, tips);
  for (const LimbTip& limb : limbs) {
    if (limb.reach < least_reach) continue;
    const CellPlace& cell = cells[static_cast<std::size_t>(
        std::lower_bound(tips.begin(), tips.end(), limb.vertex) - tips.begin())];
    const Vec3 tip =
        lattice.spacing * Vec3{static_cast<double>(cell[0]) + 0.5, static_cast<double>(cell[1]) + 0.5,
                               static_cast<double>(cell[2]) + 0.5};
    const PointIndex::Found end = index.find(tip);
    if (end.distance >= (kNearTip + limb.width) * lattice.spacing) continue;
    const Vec3 before = ridge.vertices[end.number].position;
    if (ends.is_end[end.number] && norm(ends.tip[end.number] - before) > end.distance) continue;
    ends.is_end[end.number] = 1;
    ends.tip[end.number] = tip;
  }
  return ends;
}

Groups<std::uint32_t> neighbours_along(std::size_t vertices, std::span<const Segment> segments) {
  return {vertices, [&](const auto& put) {
            for (const auto& [a, b] : segments) {
              put(a, b);
              put(b, a);
            }
          }};
}

// Ends stay where they are.
void make_smooth(const Solid& solid, const Lattice& lattice, CurveSkeleton& curve,
                 ExecutionContext* context) {
  const Groups<std::uint32_t> neighbours = neighbours_along(curve.vertices.size(), curve.segments);
  std::vector<Vec3> places, moved;
  for (const SheetVertex& vertex : curve.vertices) places.push_back(vertex.position);
  const auto move = [&](double step) {
    moved = places;
    for (std::size_t v = 0; v < places.size(); ++v) {
      const auto around = neighbours[v];
      if (around.size() < 2) continue;
      Vec3 mean;
      for (const std::uint32_t to : around)
        mean = mean + (1 / static_cast<double>(around.size())) * places[to];
      moved[v] = places[v] + step * (mean - places[v]);
    }
    places.swap(moved);
  };
  for (int pass = 0; pass < kPasses; ++pass) {
    throw_if_stopped(context);
    move(kStep);
    move(kStepBack);
  }
  const SolidMembership membership(solid.mesh);
  for (std::size_t v = 0; v < places.size(); ++v) {
    Vec3& at = curve.vertices[v].position;
    Vec3 way = places[v] - at;
    for (int halved = 0; halved < 4; ++halved, way = 0.5 * way) {
      if (!membership.contains(scaled_place(lattice, (1 / lattice.spacing) * (at + way)))) continue;
      at = at + way;
      break;
    }
  }
}

// Points that no way leads to lie in fragments, which have no skeleton: the nearest vertex takes them.
void give_the_rest(const Lattice& lattice, CurveSkeleton& curve) {
  std::vector<std::uint32_t> rest;
  for (std::uint32_t p = 0; p < curve.nearest.size(); ++p)
    if (curve.nearest[p] == DualComplex::kNone) rest.push_back(p);
  if (rest.empty()) return;
  std::vector<Vec3> places;
  for (const SheetVertex& vertex : curve.vertices) places.push_back(vertex.position);
  const PointIndex index(places);
  const std::vector<LatticePlace> at = lattice_places(lattice, rest);
  for (std::size_t n = 0; n < rest.size(); ++n) {
    const Vec3 place = lattice.spacing * Vec3{double(at[n][0]), double(at[n][1]), double(at[n][2])};
    curve.nearest[rest[n]] = index.find(place).number;
  }
}

// Per vertex of the ridge: that of the curve which is nearest along it.
std::vector<std::uint32_t> nearest_on_curve(const RidgeSheet& ridge, std::span<const std::uint32_t> lines) {
  std::vector<std::uint32_t> sources(ridge.vertices.size(), kNoNode);
  for (std::uint32_t v = 0; v < lines.size(); ++v) sources[lines[v]] = v;
  std::vector<Segment> edges = ridge.segments;
  for (const auto& [a, b, c] : ridge.triangles) edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
  const Groups<std::uint32_t> neighbours = neighbours_along(ridge.vertices.size(), edges);
  CheapestWays ways(std::move(sources));
  ways.find([&](std::uint32_t v, const auto& go) {
    for (const std::uint32_t to : neighbours[v])
      go(to, norm(ridge.vertices[to].position - ridge.vertices[v].position), v);
  });
  return std::move(ways.source);
}

// A sample point belongs to where the part of the ridge that it is nearest to is collapsed to.
void give_points(const RidgeBasis& basis, const RidgeSheet& ridge, std::span<const std::uint32_t> lines,
                 CurveSkeleton& curve, ExecutionContext* context) {
  std::vector<RealmSeed> seeds;
  for (const SheetVertex& vertex : ridge.vertices)
    seeds.push_back({vertex.point, basis.radius[vertex.point]});
  const std::vector<std::uint32_t> on_curve = nearest_on_curve(ridge, lines);
  curve.nearest = realms(basis.complex, seeds, context);
  for (std::uint32_t& nearest : curve.nearest)
    if (nearest != DualComplex::kNone) nearest = on_curve[nearest];
}

// The direction of a line at its end, by a stretch of about a length; 0 where it has none.
Vec3 direction_at_end(const CurveSkeleton& curve, const Groups<std::uint32_t>& neighbours, std::uint32_t end,
                      double length) {
  const Vec3 at = curve.vertices[end].position;
  std::uint32_t before = end, v = end;
  while (norm(curve.vertices[v].position - at) < length && (v == end || neighbours[v].size() == 2)) {
    const auto around = neighbours[v];
    const std::uint32_t next = around[0] == before && around.size() == 2 ? around[1] : around[0];
    before = v;
    v = next;
  }
  const Vec3 way = at - curve.vertices[v].position;
  return norm(way) > 0 ? (1 / norm(way)) * way : Vec3{};
}

// The ridge ends before its limb does: the line goes straight on as far as the tip.  Half way there it must still be in
// the solid.
void move_to_tips(const Solid& solid, const Lattice& lattice, const LimbEnds& ends,
                  std::span<const std::uint32_t> lines, CurveSkeleton& curve) {
  const SolidMembership membership(solid.mesh);
  const auto inside = [&](const Vec3& place) {
    return membership.contains(scaled_place(lattice, (1 / lattice.spacing) * place));
  };
  const Groups<std::uint32_t> neighbours = neighbours_along(curve.vertices.size(), curve.segments);
  for (std::uint32_t v = 0; v < lines.size(); ++v) {
    if (!ends.is_end[lines[v]] || neighbours[v].size() != 1) continue;
    Vec3& at = curve.vertices[v].position;
    const Vec3 way = ends.tip[lines[v]] - at;
    const Vec3 along = direction_at_end(curve, neighbours, v, norm(way) + kNearTip * lattice.spacing);
    const Vec3 tip = at + std::max(dot(way, along), 0.0) * along;
    if (inside(tip) && inside(0.5 * (at + tip))) at = tip;
  }
}

void find_distances(const Solid& solid, const Lattice& lattice, CurveSkeleton& curve) {
  const DistanceToMesh surface(solid.mesh);
  for (const SheetVertex& vertex : curve.vertices) {
    const Vec3 place = scaled_place(lattice, (1 / lattice.spacing) * vertex.position);
    curve.distance.push_back(solid.scale() * surface.nearest(place));
  }
}

void measure(const Lattice& lattice, CurveSkeleton& curve) {
  give_the_rest(lattice, curve);
  curve.share.assign(curve.vertices.size(), 0);
  for (const std::uint32_t vertex : curve.nearest)
    curve.share[vertex] += 1 / static_cast<double>(lattice.points);
  curve.beyond = volume_beyond(curve.segments, curve.share);
}

}  // namespace

CurveSkeleton curve_skeleton(const Solid& solid, const Lattice& lattice, const RidgeBasis& basis,
                             const RidgeSheet& ridge, const CurveOptions& options) {
  require_within(options.least_reach, 1e-6, 1e6,
                 "the least length of a limb must lie between 1e-6 and 1e6 radii");
  const LimbEnds ends = ends_of_limbs(lattice, basis, ridge, options.least_reach);
  const SheetLines lines = sheet_lines(ridge, ends.is_end, options.context);
  CurveSkeleton curve;
  curve.opened = lines.opened;
  curve.segments = lines.segments;
  for (const std::uint32_t v : lines.vertices) {
    curve.vertices.push_back(ridge.vertices[v]);
    curve.part.push_back(ridge.part[v]);
  }
  give_points(basis, ridge, lines.vertices, curve, options.context);
  move_to_tips(solid, lattice, ends, lines.vertices, curve);
  make_smooth(solid, lattice, curve, options.context);
  find_distances(solid, lattice, curve);
  measure(lattice, curve);
  curve.branches = static_cast<std::uint32_t>(polylines(curve.vertices.size(), curve.segments).size());
  std::vector<std::uint32_t> degree(curve.vertices.size(), 0);
  for (const Segment& segment : curve.segments)
    for (const std::uint32_t v : segment) ++degree[v];
  curve.ends = static_cast<std::uint32_t>(std::count(degree.begin(), degree.end(), 1));
  return curve;
}

}  // namespace affskel::core
