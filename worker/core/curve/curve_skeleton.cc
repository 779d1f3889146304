#include "core/curve/curve_skeleton.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "core/base/cheapest_ways.h"
#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/base/parallel.h"
#include "core/base/require.h"
#include "core/collapse/realms.h"
#include "core/contour/edge_cells.h"
#include "core/curve/centre_lines.h"
#include "core/curve/hanging_patches.h"
#include "core/curve/hub_stars.h"
#include "core/curve/joined_links.h"
#include "core/curve/limb_forks.h"
#include "core/curve/limb_hubs.h"
#include "core/curve/limb_radii.h"
#include "core/curve/limb_sections.h"
#include "core/curve/limb_surface.h"
#include "core/curve/limb_tubes.h"
#include "core/curve/line_ends.h"
#include "core/curve/pruned_lines.h"
#include "core/curve/sheet_lines.h"
#include "core/curve/sliced_lines.h"
#include "core/curve/volume_beyond.h"
#include "core/curve/zipped_lines.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/edges.h"
#include "core/mesh/polylines.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/point_index.h"

namespace affskel::core {
namespace {

// A tip that the ridge reaches lies no farther from it than half its limb's width and so many spacings.
constexpr double kNearTip = 2;

// Spacings: what is thinner tells nothing by how far it leads out.
constexpr double kLeastThickness = 3;

// Which vertices of the ridge are the ends of limbs, and where the tips of these are, frame coordinates.
struct LimbEnds {
  std::vector<char> is_end;
  std::vector<Vec3> tip;
  std::vector<char> has_tip;                                     // of limbs that are too short, too
  double least_reach = std::numeric_limits<double>::infinity();  // of these limbs
};

std::vector<double> balls_of(const Lattice& lattice, const RidgeBasis& basis, const RidgeSheet& ridge) {
  std::vector<double> balls;
  for (const SheetVertex& vertex : ridge.vertices)
    balls.push_back(lattice.spacing * static_cast<double>(basis.radius[vertex.point]));
  return balls;
}

// A flat limb, about as wide as long, mostly has no tip of its own.  Its reach is how far it leads out of the balls about
// the lines that there are without it.
// @return whether there are any.
bool add_flat_limbs(const RidgeSheet& ridge, std::span<const double> balls, double least_reach,
                    const SheetLines& lines, LimbEnds& ends) {
  bool any = false;
  for (const HangingPatch& patch : hanging_patches(ridge, balls, ends.has_tip)) {
    const Vec3& end = ridge.vertices[patch.end].position;
    double outside = std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : lines.vertices)
      outside = std::min(outside, norm(end - ridge.vertices[v].position) - balls[v]);
    const double reach = outside / patch.width;
    if (!(reach >= least_reach)) continue;
    ends.is_end[patch.end] = 1;
    ends.tip[patch.end] = end;
    ends.least_reach = std::min(ends.least_reach, reach);
    any = true;
  }
  return any;
}

// Of their tips, frame coordinates.
std::vector<Vec3> places_of(const Lattice& lattice, const std::vector<LimbTip>& limbs) {
  std::vector<DualComplex::Cell> tips;
  for (const LimbTip& limb : limbs) tips.push_back(limb.vertex);
  std::vector<Vec3> places = places_of_vertices(lattice, tips);
  for (Vec3& place : places) place = lattice.spacing * place;
  return places;
}

// A finger that the lattice joins to another is as long as without that: so is the limb whose tip is nearest.
void raise_reaches(const Lattice& lattice, const std::vector<LimbTip>& cut, std::vector<LimbTip>& limbs) {
  if (limbs.empty()) return;
  const std::vector<Vec3> tips = places_of(lattice, limbs), all = places_of(lattice, cut);
  const PointIndex index(tips);
  for (std::size_t n = 0; n < all.size(); ++n) {
    double& reach = limbs[index.find(all[n]).number].reach;
    reach = std::max(reach, cut[n].reach);
  }
}

LimbEnds ends_of_limbs(const Lattice& lattice, const RidgeBasis& basis, const RidgeSheet& ridge,
                       double least_reach) {
  LimbEnds ends{std::vector<char>(ridge.vertices.size(), 0), std::vector<Vec3>(ridge.vertices.size()),
                std::vector<char>(ridge.vertices.size(), 0)};
  const std::vector<Vec3> places = positions(ridge);
  const PointIndex index(places);
  std::vector<LimbTip> limbs = basis.limbs;
  limbs.insert(limbs.end(), ridge.filled.limbs.begin(), ridge.filled.limbs.end());
  raise_reaches(lattice, basis.cut_limbs, limbs);
  const std::vector<Vec3> tips = places_of(lattice, limbs);
  for (std::size_t n = 0; n < limbs.size(); ++n) {
    const LimbTip& limb = limbs[n];
    const Vec3 tip = tips[n];
    const PointIndex::Found end = index.find(tip);
    if (end.distance >= (kNearTip + limb.width) * lattice.spacing) continue;
    ends.has_tip[end.number] = 1;
    if (limb.reach < least_reach) continue;
    ends.least_reach = std::min(ends.least_reach, limb.reach);
    const Vec3 before = ridge.vertices[end.number].position;
    if (ends.is_end[end.number] && norm(ends.tip[end.number] - before) > end.distance) continue;
    ends.is_end[end.number] = 1;
    ends.tip[end.number] = tip;
  }
  return ends;
}

// Points that no way leads to lie in fragments, which have no skeleton: the nearest vertex takes them.
void give_the_rest(const Lattice& lattice, CurveSkeleton& curve) {
  std::vector<std::uint32_t> rest;
  for (std::uint32_t p = 0; p < curve.nearest.size(); ++p)
    if (curve.nearest[p] == kNone) rest.push_back(p);
  if (rest.empty()) return;
  const std::vector<Vec3> places = positions(curve);
  const PointIndex index(places);
  const std::vector<LatticePlace> at = lattice_places(lattice, rest);
  for (std::size_t n = 0; n < rest.size(); ++n)
    curve.nearest[rest[n]] = index.find(lattice.spacing * vector_of(at[n])).number;
}

// Per vertex of the ridge: that of the curve which is nearest along it.
std::vector<std::uint32_t> nearest_on_curve(const RidgeSheet& ridge, std::span<const std::uint32_t> lines) {
  std::vector<std::uint32_t> sources(ridge.vertices.size(), kNone);
  for (std::uint32_t v = 0; v < lines.size(); ++v) sources[lines[v]] = v;
  std::vector<Segment> edges = ridge.segments;
  for (const auto& [a, b, c] : ridge.triangles) edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
  const Adjacency beside = neighbours(ridge.vertices.size(), edges);
  CheapestWays ways(std::move(sources));
  ways.find([&](std::uint32_t v, const auto& go) {
    for (const std::uint32_t to : beside[v])
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
    if (nearest != kNone) nearest = on_curve[nearest];
}

// @param places per vertex of the ridge.
SheetLines with_joints(const SheetLines& lines, std::span<const char> ends, std::span<const double> balls,
                       double spacing, std::vector<Vec3>& places, ExecutionContext* context) {
  const SheetLines zipped =
      zipped_lines(joined_links(lines, places, balls, context), ends, balls, spacing, places, context);
  return joined_links(zipped, places, balls, context);
}

// Where lines run, instead of the distance to the surface, which falls by two standard deviations of noise.
std::vector<double> thickness_along(const LimbSections& sections, const SheetLines& lines,
                                    std::span<const Vec3> places, std::span<const double> balls,
                                    unsigned threads) {
  std::vector<double> thickness(balls.begin(), balls.end());
  parallel_for(threads, lines.vertices.size(), [&](std::size_t n) {
    const std::uint32_t v = lines.vertices[n];
    if (balls[v] > 0) thickness[v] = sections.thickness(places[v], balls[v]);
  });
  return thickness;
}

void move_to_middle(const CurveInput& in, const CurveOptions& options, const LimbEnds& ends,
                    std::span<const std::uint32_t> lines, CurveSkeleton& curve) {
  std::vector<Vec3> places = positions(curve), tips;
  std::vector<char> has_tip;
  for (const std::uint32_t v : lines) {
    tips.push_back(ends.tip[v]);
    has_tip.push_back(ends.is_end[v]);
  }
  centre_lines(
      {in.surface, curve.segments, tips, has_tip, in.lattice.spacing, options.threads, options.context},
      places);
  for (std::uint32_t v = 0; v < lines.size(); ++v) curve.vertices[v].position = places[v];
}

void find_distances(const CurveInput& in, unsigned threads, CurveSkeleton& curve) {
  const DistanceToMesh surface(in.solid.mesh, threads);
  const auto distance = [&](const Vec3& position) {
    return in.solid.scale() * surface.nearest(scaled_from_frame(in.lattice, position));
  };
  curve.distance.resize(curve.vertices.size());
  parallel_for(threads, curve.vertices.size(),
               [&](std::size_t v) { curve.distance[v] = distance(curve.vertices[v].position); });
  for (Opening& opening : curve.opened) opening.distance = distance(opening.place);
}

// Of sections across lines, which have their directions by what lies in balls about the vertices.
// @param size_of (place, unit normal, ball), of several threads at once
template <class SizeOf>
std::vector<double> section_sizes(std::span<const Vec3> places, std::span<const double> balls,
                                  std::span<const std::vector<std::uint32_t>> lines, unsigned threads,
                                  const SizeOf& size_of) {
  std::vector<Vec3> across(places.size());  // of the last of its lines where a joint has several
  for (const auto& line : lines)
    for (std::size_t n = 0; n < line.size(); ++n)
      if (const Vec3 way = direction_in_ball(places, line, n, balls[line[n]]); way != Vec3{})
        across[line[n]] = way;
  std::vector<double> sizes(places.size(), 0);
  parallel_for(threads, places.size(), [&](std::size_t v) {
    if (across[v] != Vec3{}) sizes[v] = size_of(places[v], across[v], balls[v]);
  });
  return sizes;
}

std::vector<char> vertices_in_joints(std::span<const Vec3> places,
                                     std::span<const std::vector<std::uint32_t>> lines,
                                     std::span<const std::vector<LimbFork>> forks) {
  std::vector<char> in_joint(places.size(), 0);
  for (std::uint32_t l = 0; l < lines.size(); ++l) {
    const auto& line = lines[l];
    const std::size_t first = before_forks(places, lines, forks[line.front()], {l, false});
    const std::size_t last = before_forks(places, lines, forks[line.back()], {l, true});
    for (std::size_t n = 0; n < line.size(); ++n)
      if (n < first || n + last >= line.size()) in_joint[line[n]] = 1;
  }
  return in_joint;
}

// In the coordinates of the mesh, so that sections are across.
void find_radii(const CurveInput& in, std::span<const std::vector<std::uint32_t>> lines,
                std::span<const char> in_joint, unsigned threads, CurveSkeleton& curve) {
  std::vector<Vec3> places;
  for (const SheetVertex& vertex : curve.vertices)
    places.push_back(scaled_from_frame(in.lattice, vertex.position));
  std::vector<double> balls = curve.distance;
  for (double& ball : balls) ball /= in.solid.scale();
  const double volume = in.solid.scaled(in.solid.volume);
  const std::vector<double> tube = slice_radii({places, lines, curve.slice, balls, volume});
  const LimbSections sections(in.solid.mesh, threads);
  const std::vector<double> area = section_sizes(
      places, balls, lines, threads,
      [&](const Vec3& at, const Vec3& across, double ball) { return sections.area(at, across, ball); });
  curve.radius = limb_radii({lines, curve.share, curve.slice, tube, balls, area, in_joint, volume});
  for (double& radius : curve.radius) radius *= in.solid.scale();
}

// Points of lines that are gone go to the nearest vertex of what is drawn there: along it they might go the wrong way.
void give_to_stars(const Lattice& lattice, const LimbHubs& hubs, std::span<const std::uint32_t> number,
                   const CurveOptions& options, CurveSkeleton& curve) {
  std::vector<std::vector<std::uint32_t>> own(hubs.hubs.size());
  for (std::uint32_t v = 0; v < hubs.of.size(); ++v)
    if (hubs.of[v] != kNone) own[hubs.of[v]].push_back(v);
  std::vector<PointIndex> indices;
  for (auto& vertices : own) {
    for (const auto& [a, b] : curve.segments)  // and where its limbs begin
      for (const auto& [in, out] : {std::pair(a, b), std::pair(b, a)})
        if (hubs.at(in) == &hubs.hubs[indices.size()] && hubs.of[out] == kNone) vertices.push_back(out);
    std::vector<Vec3> places;
    for (const std::uint32_t v : vertices) places.push_back(curve.vertices[v].position);
    indices.emplace_back(places);
  }
  const auto nearest_of = [&](const Vec3& at, std::uint32_t before) {
    const std::uint32_t vertex = number[before], hub = hubs.of[vertex];
    if (hub == kNone || hubs.hubs[hub].joint != vertex) return vertex;
    return own[hub][indices[hub].find(at).number];
  };
  given_anew(lattice, nearest_of, curve.vertices.size(), curve.nearest, options.threads, options.context);
}

SlicedLines sliced(const CurveInput& in, const CurveOptions& options, CurveSkeleton& curve) {
  return sliced_lines({in.solid, in.lattice, in.surface, curve, options.threads, options.context},
                      curve.nearest);
}

// Limbs, and the bodies that they hang on.
struct LimbsAndHubs {
  SlicedLines limbs;
  LimbHubs hubs = {};
  bool are_drawn_anew = false;  // the lines: limbs is of those before
};

// Draws lines anew in flat bodies.
LimbsAndHubs with_hubs(const CurveInput& in, const CurveOptions& options, CurveSkeleton& curve) {
  give_the_rest(in.lattice, curve);
  LimbsAndHubs found{sliced(in, options, curve)};
  const auto& [places, balls, slices, radius, lines] = found.limbs;
  const std::vector<double> section = section_sizes(places, balls, lines, options.threads,
                                                    [&](const Vec3& at, const Vec3& across, double ball) {
                                                      return in.surface.sections.at(at, across, ball).radius;
                                                    });
  found.hubs = limb_hubs({places, lines, radius, section, in.lattice, curve.nearest, options.context});
  const auto number = draw_hub_stars(in.surface, in.lattice.spacing, found.hubs, curve);
  found.are_drawn_anew = !number.empty();
  if (found.are_drawn_anew) give_to_stars(in.lattice, found.hubs, number, options, curve);
  return found;
}

void measure(const CurveInput& in, const CurveOptions& options, LimbsAndHubs found, CurveSkeleton& curve) {
  if (found.are_drawn_anew) found.limbs = sliced(in, options, curve);
  const auto& [places, balls, slices, radius, lines] = found.limbs;
  curve.slice = slices;
  std::vector<char> is_hubs(places.size(), 0);
  for (std::size_t v = 0; v < places.size(); ++v) is_hubs[v] = found.hubs.of[v] != kNone;
  const LimbSections& sections = in.surface.sections;
  const auto forks = limb_forks(places, lines, sections, in.lattice.spacing, is_hubs);
  const auto ellipse_at = [&](const Vec3& place, const Vec3& u, const Vec3& v, double ball) {
    return sections.ellipse(place, u, v, ball);
  };
  const auto owner_of = limb_tubes({places, lines, balls, radius, forks, std::move(found.hubs), ellipse_at});
  curve.share =
      given_anew(in.lattice, owner_of, places.size(), curve.nearest, options.threads, options.context);
  curve.beyond = volume_beyond(curve.segments, curve.share);
  find_distances(in, options.threads, curve);
  std::vector<char> in_joint = vertices_in_joints(places, lines, forks);
  for (std::size_t v = 0; v < places.size(); ++v)
    if (is_hubs[v]) in_joint[v] = 1;
  find_radii(in, lines, in_joint, options.threads, curve);
  curve.branches = static_cast<std::uint32_t>(lines.size());
  for (const std::uint32_t ends : ends_of(places.size(), lines)) curve.ends += ends == 1;
}

// @return which vertices of the ridge its own are.
std::vector<std::uint32_t> draw_in_middle(const CurveInput& in, const CurveOptions& options,
                                          CurveSkeleton& curve) {
  const std::vector<double> balls = balls_of(in.lattice, in.basis, in.ridge);
  LimbEnds ends = ends_of_limbs(in.lattice, in.basis, in.ridge, options.least_reach);
  SheetLines lines = sheet_lines(in.ridge, ends.is_end, options.context);
  if (add_flat_limbs(in.ridge, balls, options.least_reach, lines, ends))
    lines = sheet_lines(in.ridge, ends.is_end, options.context);
  std::vector<Vec3> places = positions(in.ridge);
  const std::vector<double> thickness =
      thickness_along(in.surface.sections, lines, places, balls, options.threads);
  lines = pruned_lines(lines, in.ridge, thickness, kLeastThickness * in.lattice.spacing, options.context);
  lines = with_joints(lines, ends.is_end, balls, in.lattice.spacing, places, options.context);
  curve.same_to = ends.least_reach;
  for (const std::uint32_t v : lines.opened) curve.opened.push_back({in.ridge.vertices[v].position});
  curve.segments = std::move(lines.segments);
  for (const std::uint32_t v : lines.vertices) {
    curve.vertices.push_back(in.ridge.vertices[v]);
    curve.vertices.back().position = places[v];
    curve.part.push_back(in.ridge.part[v]);
  }
  move_to_middle(in, options, ends, lines.vertices, curve);
  return std::move(lines.vertices);
}

// With the points that each vertex has.
LimbsAndHubs draw(const CurveInput& in, const CurveOptions& options, CurveSkeleton& curve) {
  require_within(options.least_reach, 1e-6, 1e6,
                 "the least length of a limb must lie between 1e-6 and 1e6 radii");
  const std::vector<std::uint32_t> lines = draw_in_middle(in, options, curve);
  give_points(in.basis, in.ridge, lines, curve, options.context);
  return with_hubs(in, options, curve);
}

}  // namespace

LimbSurface limb_surface(const Solid& solid, const Lattice& lattice, unsigned threads) {
  Mesh surface = surface_in_lattice(solid, lattice);
  for (Vec3& p : surface.points) p = lattice.spacing * p;
  return LimbSurface(std::move(surface), threads);
}

SheetMesh curve_lines(const CurveInput& input, const CurveOptions& options) {
  CurveSkeleton curve;
  draw(input, options, curve);
  return curve;
}

CurveSkeleton curve_skeleton(const CurveInput& input, const CurveOptions& options) {
  CurveSkeleton curve;
  LimbsAndHubs found = draw(input, options, curve);
  measure(input, options, std::move(found), curve);
  return curve;
}

}  // namespace affskel::core
