#include "core/ridge/skeleton_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/cheapest_ways.h"
#include "core/base/matrix3.h"
#include "core/base/none.h"
#include "core/base/unit.h"
#include "core/contour/dual_contour.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/edges.h"
#include "core/mesh/patch_senses.h"
#include "core/ridge/drawn_out_lines.h"
#include "core/ridge/drawn_rims.h"
#include "core/ridge/local_depth.h"
#include "core/ridge/ridge_constants.h"
#include "core/ridge/skeleton_cells.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

constexpr int kRimPasses = 24;        // of rims: over about three neighbours
constexpr int kSurfacePasses = 72;    // of what lies within: it goes on following the rim
constexpr int kFreePasses = 60;       // of ways and membranes: over about five neighbours
constexpr double kNearCrest = 0.8;    // how far a vertex may be from the crest of P that it goes to, radii
constexpr double kLongestStep = 0.1;  // of a vertex to the crest of P in one pass, spacings
constexpr double kThin = 2;           // a vertex moves freely about points farther from the surface, spacings
constexpr int kLinePasses = 30;       // of ways and curves
// A vertex leaves its sample point for a nearer one once it is so far away, along an axis, in spacings.  It begins half-way
// between points, where at 0.5 rounding would choose, so that a mapped mesh had other lines in the frame `affine`.
constexpr double kLeaves = 0.5 + 1e-6;

class Placing {
 public:
  Placing(const Solid& solid, const DualComplex& complex, const CellSet& left, const SkeletonParts& from)
      : complex_(complex),
        from_(from),
        membership_(solid.mesh),
        to_mesh_(inverse_transposed(frame_matrix(from.lattice))),
        cells_(complex, left),
        neighbours_(neighbours(cells_.vertices.size(), cells_.segments)),
        rim_neighbours_(cells_.rim_neighbours()) {}

  SkeletonMesh run(ExecutionContext* context) {
    make_vertices();
    throw_if_stopped(context);
    mesh_.vertices = drawn_rims(mesh_.vertices, cells_.rings, rim_neighbours_, from_.low);
    even_out_rims(context);
    find_ways_to_bound();
    even_out(bound_, kFreePasses, context,
             [&](std::uint32_t v, int) { return kept_off_surface(v, drawn(v)); });
    const std::vector<char> fixed = fixed_on_lines();
    even_out(fixed, kLinePasses, context, [&](std::uint32_t v, int) { return unbent(v, fixed); });
    for (std::uint32_t v = 0; v < cells_.vertices.size(); ++v)
      if (!bound_[v]) take_values(v);
    draw_out_lines();
    make_faces();
    return std::move(mesh_);
  }

 private:
  void make_vertices() {
    const std::vector<CellPlace> places = cells_of_vertices(from_.lattice, cells_.vertices);
    bound_.assign(cells_.vertices.size(), 0);
    clear_.resize(cells_.vertices.size());
    for (std::uint32_t v = 0; v < cells_.vertices.size(); ++v) {
      mesh_.vertices.push_back(free_vertex(cells_.vertices[v], places[v]));
      point_place_.push_back((1 / from_.lattice.spacing) *
                             place_of(complex_.star(cells_.vertices[v]).members[0], places[v]));
      mesh_.part.push_back(from_.parts.of_point(DualComplex::cube_of(cells_.vertices[v])));
    }
    place_surface();
    place_curves();
  }

  // The vertex of the surface in the cell of a vertex that it goes through.
  const SheetVertex& on_surface(std::uint32_t v) const {
    const auto& cells = from_.cells.vertex;
    const auto at = std::lower_bound(cells.begin(), cells.end(), cells_.vertices[v]);
    return from_.surface[static_cast<std::size_t>(at - cells.begin())];
  }

  // Squares among the anchors are the surface's.
  void place_surface() {
    CellSet anchored(complex_);
    for (const Anchor& anchor : from_.anchors.anchors) anchored.insert(anchor.cell);
    std::vector<char> of_surface(cells_.vertices.size(), 0);
    for (const auto& triangle : cells_.fans)
      for (const std::uint32_t v : triangle) mesh_.vertices[v].kind = SkeletonKind::kMembrane;
    for (std::size_t s = 0; s < cells_.squares.size(); ++s) {
      const auto& ring = cells_.rings[s];
      const bool ridge = anchored.has(cells_.squares[s]);
      for (const std::uint32_t v : ring) {
        if (ridge) of_surface[v] = 1;
        mesh_.vertices[v].kind = SkeletonKind::kMembrane;
      }
    }
    for (std::uint32_t v = 0; v < cells_.vertices.size(); ++v) {
      if (!of_surface[v]) continue;
      const std::uint32_t point = mesh_.vertices[v].point;
      mesh_.vertices[v] = on_surface(v);
      mesh_.vertices[v].point = point;
      bound_[v] = 1;
    }
  }

  void place_curves() {
    for (const CurvePlace& place : from_.anchors.curves) {
      const std::uint32_t v = cells_.number(place.vertex);
      if (v == cells_.vertices.size() || cells_.vertices[v] != place.vertex || bound_[v]) continue;
      mesh_.vertices[v] = place.at;
      mesh_.vertices[v].kind = SkeletonKind::kCurve;
      bound_[v] = 1;
    }
  }

  // Of a sample point at a corner of a cell.
  Vec3 place_of(const DualComplex::Star::Member& corner, const CellPlace& cell) const {
    const auto along = [&](std::size_t axis) {
      return static_cast<double>(cell[axis]) + (DualComplex::digit(corner.place, axis) == 0 ? 1 : 0);
    };
    return from_.lattice.spacing * Vec3{along(0), along(1), along(2)};
  }

  // In the middle of the sample points about it.
  SheetVertex free_vertex(Cell vertex, const CellPlace& cell) const {
    const auto star = complex_.star(vertex);
    SheetVertex result;
    result.point = star.members[0].cube;
    for (const DualComplex::Star::Member& member : star)
      result.position = result.position + (1 / static_cast<double>(star.count)) * place_of(member, cell);
    if (!inside(result.position)) result.position = place_of(star.members[0], cell);
    result.kind = SkeletonKind::kWay;
    return result;
  }

  bool inside(const Vec3& u) const { return membership_.contains(scaled_from_frame(from_.lattice, u)); }

  // What lies within a surface goes along with the rim, the less the farther from it: a rim that is drawn in would leave it
  // outside.
  void even_out_rims(ExecutionContext* context) {
    const std::vector<char> fixed_rim = fixed_on_rim();
    std::vector<char> fixed = fixed_rim;
    for (const auto& ring : cells_.rings)
      for (const std::uint32_t v : ring)
        if (bound_[v] && rim_neighbours_[v].empty()) fixed[v] = 0;
    const std::vector<Vec3> before = positions(mesh_);
    const auto moved = [&](std::uint32_t v) { return place(v) - before[v]; };
    const std::vector<int> passes = rim_passes(rim_neighbours_, kRimPasses);
    even_out(fixed, kSurfacePasses, context, [&](std::uint32_t v, int pass) {
      if (!fixed_rim[v] && pass >= passes[v]) return Vec3{};
      if (!fixed_rim[v]) return kept_off_surface(v, 0.5 * way_to_mean(v, rim_neighbours_));
      Vec3 way = -moved(v);
      for (const std::uint32_t to : neighbours_[v])
        way = way + (1 / static_cast<double>(neighbours_[v].size())) * moved(to);
      return way;
    });
  }

  // Corners of the rim, and where something else begins, stay.
  std::vector<char> fixed_on_rim() const {
    std::vector<char> fixed(cells_.vertices.size(), 1);
    for (std::uint32_t v = 0; v < fixed.size(); ++v)
      if (rim_neighbours_[v].size() == 2 && bound_[v]) fixed[v] = 0;
    return fixed;
  }

  // Ends, branches and what lies in a surface stay.
  std::vector<char> fixed_on_lines() const {
    std::vector<char> fixed(cells_.vertices.size(), 0);
    for (const auto& ring : cells_.rings)
      for (const std::uint32_t v : ring) fixed[v] = 1;
    for (const auto& triangle : cells_.fans)
      for (const std::uint32_t v : triangle) fixed[v] = 1;
    for (std::uint32_t v = 0; v < fixed.size(); ++v)
      if (neighbours_[v].size() != 2) fixed[v] = 1;
    return fixed;
  }

  // In each pass every vertex that is not fixed goes along step(v, pass), as far as the solid lets it in the end.
  template <class Step>
  void even_out(const std::vector<char>& fixed, int passes, ExecutionContext* context, const Step& step) {
    std::vector<std::uint32_t> moving;
    for (std::uint32_t v = 0; v < cells_.vertices.size(); ++v)
      if (!fixed[v]) moving.push_back(v);
    std::vector<Vec3> before(moving.size()), moved(moving.size());
    for (std::size_t n = 0; n < moving.size(); ++n) before[n] = place(moving[n]);
    for (int pass = 0; pass < passes; ++pass) {
      throw_if_stopped(context);
      for (std::size_t n = 0; n < moving.size(); ++n) moved[n] = place(moving[n]) + step(moving[n], pass);
      for (std::size_t n = 0; n < moving.size(); ++n) mesh_.vertices[moving[n]].position = moved[n];
    }
    StopCheck stop(context);
    for (std::size_t n = 0; n < moving.size(); ++n, stop.did(1000)) {
      Vec3& at = mesh_.vertices[moving[n]].position;
      double share = 1;
      while (share > 0.2 && !inside(before[n] + share * (moved[n] - before[n]))) share *= 0.5;
      at = share > 0.2 ? before[n] + share * (moved[n] - before[n]) : before[n];
    }
  }

  // Along edges, which are about a spacing long.
  void find_ways_to_bound() {
    std::vector<std::uint32_t> bound(bound_.size(), kNone);
    for (std::uint32_t v = 0; v < bound.size(); ++v)
      if (bound_[v]) bound[v] = v;
    CheapestWays ways(std::move(bound));
    ways.find([&](std::uint32_t v, const auto& go) {
      for (const std::uint32_t to : neighbours_[v]) go(to, 1.0, v);
    });
    way_to_bound_ = std::move(ways.cost);
  }

  const Vec3& place(std::uint32_t v) const { return mesh_.vertices[v].position; }

  // From a vertex to the mean of its neighbours.
  Vec3 way_to_mean(std::uint32_t v, const Adjacency& neighbours) const {
    const auto around = neighbours[v];
    Vec3 way;
    for (const std::uint32_t to : around)
      way = way + (1 / static_cast<double>(around.size())) * (place(to) - place(v));
    return way;
  }

  // Where its neighbours draw a vertex, and on lines the crest of P.  The end of a line goes on as the line does.
  Vec3 drawn(std::uint32_t v) {
    const auto around = neighbours_[v];
    if (around.size() == 1) {
      const auto beyond = neighbours_[around[0]];
      if (beyond.size() != 2) return {};
      const Vec3 along = unit(place(around[0]) - place(beyond[beyond[0] == v ? 1 : 0]));
      const Vec3 step = place(v) - place(around[0]);
      return 0.5 * (dot(step, along) * along - step);
    }
    const Vec3 half = 0.5 * way_to_mean(v, neighbours_);
    return around.size() == 2 ? half + way_to_crest(v, unit(place(around[1]) - place(around[0]))) : half;
  }

  // Less bent, on a line: a line drawn straight instead would be a string, with a corner where the surface holds it off.
  Vec3 unbent(std::uint32_t v, const std::vector<char>& fixed) const {
    Vec3 way = 0.25 * way_to_mean(v, neighbours_);
    for (const std::uint32_t to : neighbours_[v])
      if (!fixed[to]) way = way - 0.125 * way_to_mean(to, neighbours_);
    return way;
  }

  // How much of a way a vertex goes without coming nearer to the surface than a ridge may: along the surface where it is
  // as near as that, and off it, not far at a time, where it is nearer.
  Vec3 kept_off_surface(std::uint32_t v, const Vec3& way) {
    walk(v);
    const SheetVertex& vertex = mesh_.vertices[v];
    const auto radius = static_cast<double>(from_.radius[vertex.point]);
    const double least =
        RidgeConstants::min_radius_share * static_cast<double>(from_.derivatives[vertex.point].depth);
    if (radius >= kThin && is_surely_deep(radius, least)) return way;
    Clear& known = clear_[v];  // of a vertex that hardly moves any more it holds for many passes
    if (norm(vertex.position + way - known.about) < known.radius - from_.lattice.spacing * least) return way;
    const Vec3 at = (1 / from_.lattice.spacing) * vertex.position, off = at - from_.nearest.nearest_place(at);
    const double distance = norm(off);
    known = {vertex.position, from_.lattice.spacing * distance};
    if (distance == 0) return {};
    const Vec3 away = (1 / distance) * off;
    const double given = dot(way, away) / from_.lattice.spacing;
    const double wanted = std::max(given, std::min(least - distance, kLongestStep));
    const Vec3 kept = way + (from_.lattice.spacing * (wanted - given)) * away;
    // What goes less far than the surface is away stays inside.
    return norm(kept) < known.radius || inside(vertex.position + kept) ? kept : Vec3{};
  }

  // Across a line: Newton's step to where P is greatest, not far at a time, the less the nearer what does not move is by
  // the radius: a line goes there straight.
  Vec3 way_to_crest(std::uint32_t v, const Vec3& along) {
    const Vec3 off = walk(v);
    const PointDerivatives& here = from_.derivatives[mesh_.vertices[v].point];
    const Vec3 gradient = vector_of(here.gradient) + bent(here, off);
    const Vec3 across = gradient - dot(gradient, along) * along;
    const double slope = norm(across);
    if (slope == 0) return {};
    const Vec3 uphill = (1 / slope) * across;
    const double bend = dot(uphill, bent(here, uphill)),
                 radius = static_cast<double>(from_.radius[mesh_.vertices[v].point]),
                 reach = kNearCrest * radius;
    if (slope > -bend * reach) return {};  // no crest, or one on the wall of a hollow
    const double step = std::min(slope / -bend, kLongestStep);
    return (std::min(1.0, way_to_bound_[v] / radius) * step * from_.lattice.spacing) * uphill;
  }

  static Vec3 bent(const PointDerivatives& at, const Vec3& v) { return transposed_times(hessian_of(at), v); }

  // Makes the sample point nearest to a vertex its own, as far as the complex leads there.
  // @return the way from there to the vertex, spacings.
  Vec3 walk(std::uint32_t v) {
    SheetVertex& vertex = mesh_.vertices[v];
    Vec3& point = point_place_[v];
    Vec3 off = (1 / from_.lattice.spacing) * vertex.position - point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      while (std::abs(off[axis]) > kLeaves) {
        const double step = off[axis] > 0 ? 1 : -1;
        const std::uint32_t next = complex_.neighbour(vertex.point, axis, step > 0 ? 2 : 0);
        if (next == kNone) break;
        vertex.point = next;
        point[axis] += step;
        off[axis] -= step;
      }
    }
    return off;
  }

  // What a vertex that was moved freely has at its place, by the sample point next to it.
  void take_values(std::uint32_t v) {
    const Vec3 off = walk(v);
    SheetVertex& vertex = mesh_.vertices[v];
    const Vec3& gradient = from_.field.gradient[vertex.point];
    const double rise = from_.lattice.spacing * dot(gradient, off);
    // E is positive in the solid, and bends up towards the surface, where the gradient would go below 0.
    const double here = from_.field.erosion[vertex.point];
    vertex.erosion = std::max(0.25 * here, here + rise);
    vertex.area = section_area(to_mesh_, gradient);
    vertex.normal_a = vertex.normal_b = unit(gradient);
  }

  void draw_out_lines() {
    const auto depth = [&](const Vec3& u) {
      const Vec3 at = (1 / from_.lattice.spacing) * u;
      return inside(u) ? from_.lattice.spacing * norm(at - from_.nearest.nearest_place(at)) : 0;
    };
    const std::vector<Vec3> places = positions(mesh_);
    for (const auto& [v, place] : drawn_out_lines({places, neighbours_, from_.lattice.spacing / 4, depth})) {
      const SheetVertex drawn_in = mesh_.vertices[v];
      SheetVertex& vertex = mesh_.vertices[v];
      if (bound_[v]) vertex.point = complex_.star(cells_.vertices[v]).members[0].cube;
      vertex.position = place;
      take_values(v);
      if (bound_[v]) {  // of a curve: on its two sides
        vertex.normal_a = drawn_in.normal_a;
        vertex.normal_b = drawn_in.normal_b;
      }
      mesh_.drawn_out.push_back({v, vertex});
      vertex = drawn_in;
    }
  }

  void make_faces() {
    mesh_.triangles = cells_.fans;
    for (std::size_t s = 0; s < cells_.rings.size(); ++s)
      if (!cells_.fanned[s]) add_quad(cells_.rings[s], mesh_);
    agree_on_senses(mesh_.vertices.size(), mesh_.triangles);
    for (std::size_t s = 0; s < cells_.segments.size(); ++s)
      if (cells_.squares_at[s] == 0) mesh_.segments.push_back(cells_.segments[s]);
  }

  // A ball that the surface does not enter.
  struct Clear {
    Vec3 about;
    double radius = 0;
  };

  const DualComplex& complex_;
  const SkeletonParts& from_;
  SolidMembership membership_;
  Matrix3 to_mesh_;  // F^-T
  SkeletonCells cells_;
  Adjacency neighbours_, rim_neighbours_;
  std::vector<char> bound_;           // per vertex: its place and values are known
  std::vector<double> way_to_bound_;  // per vertex, to the nearest of these, spacings
  std::vector<Clear> clear_;          // per vertex, of those near the surface
  std::vector<Vec3> point_place_;     // per vertex that is not bound: of its sample point
  SkeletonMesh mesh_;
};

}  // namespace

void draw_out(SkeletonMesh& skeleton) {
  for (const auto& [v, at] : skeleton.drawn_out) skeleton.vertices[v] = at;
}

SkeletonMesh skeleton_mesh(const Solid& solid, const DualComplex& complex, const CellSet& left,
                           const SkeletonParts& from, ExecutionContext* context) {
  return Placing(solid, complex, left, from).run(context);
}

}  // namespace affskel::core
