#include "core/ridge/ridge_anchors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <set>

#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/base/require.h"
#include "core/ridge/surface_squares.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

class Choice {
 public:
  Choice(const RidgeEvidence& evidence, const RidgeBounds& bounds, ExecutionContext* context)
      : evidence_(evidence),
        complex_(evidence.complex),
        bounds_(bounds),
        context_(context),
        taken_(evidence.complex),
        components_(evidence.complex.cubes()) {}

  RidgeAnchors run() {
    join_components();
    leave_out_fragments();
    take_surface();
    take_curves();
    throw_if_stopped(context_);
    take_tips();
    take_core();
    take_middles();
    sort_places();
    return std::move(result_);
  }

 private:
  void take(const Anchor& anchor) {
    result_.anchors.push_back(anchor);
    insert_closed(complex_, anchor.cell, taken_);
  }

  double radius_at(const SheetVertex& vertex) const {
    return static_cast<double>(evidence_.radius[vertex.point]);
  }

  // Per square of the surface: the mean over the two sample points that it lies between.
  std::vector<double> radii_of_squares() const {
    std::vector<double> radii;
    for (const LatticeEdge& edge : evidence_.edges)
      radii.push_back(0.5 *
                      (static_cast<double>(evidence_.radius[edge.point]) +
                       static_cast<double>(evidence_.radius[complex_.neighbour(edge.point, edge.axis, 2)])));
    return radii;
  }

  void take_surface() {
    const std::vector<double> radii = radii_of_squares();
    const auto [taken, piece] = surface_squares(
        {evidence_.cells, evidence_.vertices, evidence_.strength, radii}, bounds_.low, RidgeConstants::gap);
    const auto& rings = evidence_.cells.ring;
    std::vector<char> founded(rings.size(), 0);
    std::vector<double> area(rings.size(), 0);  // of pieces; a square's four corners have a quarter each
    for (std::uint32_t e = 0; e < rings.size(); ++e) {
      if (!taken[e]) continue;
      for (const std::uint32_t v : rings[e]) {
        if (evidence_.vertices[v].strength < bounds_.low) continue;
        if (founds(evidence_.vertices[v])) founded[piece[e]] = 1;
        area[piece[e]] += 0.25 / (radius_at(evidence_.vertices[v]) * radius_at(evidence_.vertices[v]));
      }
    }
    for (std::uint32_t e = 0; e < rings.size(); ++e) {
      if (!taken[e] || !founded[piece[e]] || area[piece[e]] < RidgeConstants::min_area) continue;
      double weight = 0;
      for (const std::uint32_t v : rings[e]) weight += evidence_.vertices[v].strength;
      take({complex_.square(evidence_.edges[e].point, evidence_.edges[e].axis), static_cast<float>(weight)});
    }
  }

  // Stretches between places that are strong, and not taken by the surface.
  void take_curves() {
    for (const RidgeCurve& curve : evidence_.curves) {
      const std::size_t count = curve.vertices.size();
      for (std::size_t first = 0, last; first < count; first = last + 1) {
        for (last = first; last < count && off_surface(curve, last);) ++last;
        const bool whole = curve.closed && first == 0 && last == count;
        if (last - first >= 2) look_at({&curve, first, last, whole});
      }
    }
  }

  void sort_places() {
    auto& places = result_.curves;
    std::stable_sort(places.begin(), places.end(),
                     [](const CurvePlace& a, const CurvePlace& b) { return a.vertex < b.vertex; });
    places.erase(std::unique(places.begin(), places.end(),
                             [](const CurvePlace& a, const CurvePlace& b) { return a.vertex == b.vertex; }),
                 places.end());
  }

  bool off_surface(const RidgeCurve& curve, std::size_t v) const {
    return curve.vertices[v].strength >= bounds_.low && !taken_.has(vertex_of(curve.cells[v]));
  }

  Cell vertex_of(std::uint32_t lowest) const { return complex_.cell(lowest, DualComplex::kUpperVertex); }

  // Part of a curve, vertices first .. last - 1.
  struct Stretch {
    const RidgeCurve* curve = nullptr;
    std::size_t first = 0, last = 0;
    bool whole = false;  // of a closed curve
    double length = 0;   // radii
  };

  // Whether a vertex tells of a ridge by itself.
  bool founds(const SheetVertex& vertex) const {
    return vertex.strength >= bounds_.high && vertex.roundness <= RidgeConstants::max_roundness;
  }

  void look_at(Stretch stretch) {
    bool founded = false;
    for (std::size_t v = stretch.first; v < stretch.last; ++v) {
      const SheetVertex& here = stretch.curve->vertices[v];
      founded = founded || founds(here);
      if (v > stretch.first)
        stretch.length += norm(here.position - stretch.curve->vertices[v - 1].position) /
                          (evidence_.field.spacing * radius_at(here));
    }
    if (!founded) return;
    if (stretch.whole || stretch.length >= RidgeConstants::min_length)
      take_stretch(stretch);
    else
      short_ones_.push_back(stretch);
  }

  void take_stretch(const Stretch& stretch) {
    const auto& [curve, first, last, whole, length] = stretch;
    for (std::size_t v = first; v < last; ++v)
      result_.curves.push_back({vertex_of(curve->cells[v]), curve->vertices[v]});
    for (std::size_t v = first; v + (whole ? 0 : 1) < last; ++v) {
      const std::uint32_t next = v + 1 < last ? curve->cells[v + 1] : curve->cells[first];
      const Cell edge = edge_between(curve->cells[v], next);
      if (!taken_.has(edge)) take({edge, 0});
    }
  }

  // The edge dual to the face between two cells, by their lowest corners.
  Cell edge_between(std::uint32_t a, std::uint32_t b) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t place = DualComplex::kUpperVertex - DualComplex::kWeight[axis];
      if (complex_.neighbour(a, axis, 2) == b) return complex_.cell(b, place);
      if (complex_.neighbour(a, axis, 0) == b) return complex_.cell(a, place);
    }
    return complex_.cell(a, DualComplex::kUpperVertex);  // cells that meet at less than a face
  }

  void take_tips() {
    const std::vector<char> anchored = anchored_cubes();
    for (std::size_t n = 0; n < evidence_.limbs.size(); ++n) {
      const LimbTip& tip = evidence_.limbs[n];
      const auto reached = [&](std::uint32_t cube, float) { return anchored[cube] != 0; };
      if (taken_.has(tip.vertex) ||
          is_near(complex_, tip.vertex, static_cast<float>(allowed_from(tip)), reached))
        continue;
      if (!evidence_.doubtful.empty() && evidence_.doubtful[n]) {
        result_.doubtful.push_back(tip);
        continue;
      }
      take(anchor_of(tip));
      ++result_.limbs;
    }
  }

  void take_core() {
    if (evidence_.core.empty()) return;
    const std::vector<float> ways = shortest_ways(complex_, result_.anchors, {}, context_);
    for (const Cell cell : evidence_.core) {
      float way = kNoWay;
      for (const auto& member : complex_.star(cell)) way = std::min(way, ways[member.cube]);
      if (static_cast<double>(way) >
          RidgeConstants::end_spacings +
              RidgeConstants::end_radii * radius_about(complex_, evidence_.radius, cell))
        result_.core.push_back({cell, 0});
    }
  }

  std::vector<char> anchored_cubes() const {
    std::vector<char> anchored(complex_.cubes(), 0);
    for (const auto* anchors : {&result_.anchors, &result_.core})
      for (const Anchor& anchor : *anchors)
        for (const auto& member : complex_.star(anchor.cell)) anchored[member.cube] = 1;
    return anchored;
  }

  // How far from a tip what is anchored may end: so far from the surface, which is the tip's own radius farther away.
  // Where that is less than half its limb's, the tip may be in a corner of a blunt end: so far from three sides.
  double allowed_from(const LimbTip& tip) const {
    const double radius = radius_about(complex_, evidence_.radius, tip.vertex);
    const double sides = radius < 0.5 * tip.radius ? std::numbers::sqrt3 : 1;
    return RidgeConstants::end_spacings + sides * (RidgeConstants::end_radii * tip.radius - radius);
  }

  // Every component has its middle in its skeleton: a jar is more than its neck, an apple more than its stalk.
  void take_middles() {
    std::map<std::uint32_t, Middle> middles;  // by component
    for (std::uint32_t cube = 0; cube < complex_.cubes(); ++cube)
      look_deeper(cube, middles[components_.find(cube)]);
    std::stable_sort(short_ones_.begin(), short_ones_.end(),
                     [](const Stretch& a, const Stretch& b) { return a.length > b.length; });
    const std::vector<char> anchored = anchored_cubes();
    for (const auto& [component, found] : middles) take_middle(deepest_vertex(found.square), anchored);
  }

  // The corner of a square that is farthest from the surface; of equal ones the nearest to the middle of all cubes.
  Cell deepest_vertex(Cell square) const {
    const auto rank = [&](Cell vertex) {
      const auto radius = [&](std::uint32_t cube) { return static_cast<double>(evidence_.radius[cube]); };
      return CellRank(complex_, value_at<Continued::kFromAllCubes>(complex_, vertex, radius), vertex);
    };
    const auto corners = vertices_round(complex_, square);
    return *std::max_element(corners.begin(), corners.end(),
                             [&](Cell a, Cell b) { return rank(a) < rank(b); });
  }

  // Unless what is anchored comes near.
  void take_middle(Cell middle, const std::vector<char>& anchored) {
    const double allowed = RidgeConstants::end_spacings +
                           RidgeConstants::middle_radii * radius_about(complex_, evidence_.radius, middle);
    std::set<std::uint32_t> about;
    const auto reached = [&](std::uint32_t cube, float) {
      about.insert(cube);
      return anchored[cube] != 0;
    };
    if (is_near(complex_, middle, static_cast<float>(allowed), reached)) return;
    const auto through = std::find_if(short_ones_.begin(), short_ones_.end(), [&](const Stretch& stretch) {
      const auto cells = std::span(stretch.curve->cells).subspan(stretch.first, stretch.last - stretch.first);
      return std::any_of(cells.begin(), cells.end(),
                         [&](std::uint32_t cell) { return about.contains(cell); });
    });
    if (through != short_ones_.end())
      take_stretch(*through);
    else
      take({middle, 0});
  }

  void join_components() {
    for (std::uint32_t cube = 0; cube < complex_.cubes(); ++cube) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (const std::uint32_t to = complex_.neighbour(cube, axis, 2); to != kNone)
          components_.unite(cube, to);
    }
  }

  void leave_out_fragments() {
    struct Component {
      std::uint32_t size = 0;
      bool resolved = false;
    };
    std::map<std::uint32_t, Component> known;
    for (std::uint32_t cube = 0; cube < complex_.cubes(); ++cube) {
      Component& here = known[components_.find(cube)];
      ++here.size;
      here.resolved = here.resolved || evidence_.radius[cube] > 1;
    }
    std::map<std::uint32_t, std::uint32_t> largest;  // size, by part
    for (const auto& [cube, component] : known) {
      std::uint32_t& size = largest[evidence_.parts.of_point(cube)];
      size = std::max(size, component.size);
    }
    result_.left_out.assign(complex_.cubes(), 0);
    std::map<std::uint32_t, std::int64_t> fragments;  // Euler characteristic, by component
    for (const auto& [cube, component] : known)
      if (!component.resolved && component.size < largest[evidence_.parts.of_point(cube)])
        fragments[cube] = 0;
    if (fragments.empty()) return;
    complex_.for_each_cell([&](Cell cell) {
      if (const auto of = fragments.find(components_.find(DualComplex::cube_of(cell))); of != fragments.end())
        of->second += DualComplex::dimension(cell) % 2 == 0 ? 1 : -1;
    });
    // What has a tunnel or a void stays.
    std::erase_if(fragments, [](const auto& fragment) { return fragment.second != 1; });
    result_.fragments = static_cast<std::uint32_t>(fragments.size());
    for (std::uint32_t cube = 0; cube < complex_.cubes(); ++cube)
      result_.left_out[cube] = fragments.contains(components_.find(cube));
  }

  // The square in the middle of a component: of its two sample points E and the distance to the surface are large.  E
  // alone is greatest in the hollow of a ring.
  struct Middle {
    double depth = -1;
    Cell square = 0;
  };

  double depth_at(std::uint32_t cube) const {
    return std::sqrt(std::sqrt(evidence_.field.erosion[cube])) * static_cast<double>(evidence_.radius[cube]);
  }

  void look_deeper(std::uint32_t cube, Middle& known) const {
    const double here = depth_at(cube);
    if (here <= known.depth) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t to = complex_.neighbour(cube, axis, 2);
      const double depth = to == kNone ? 0 : std::min(here, depth_at(to));
      if (depth > known.depth) known = {depth, complex_.square(cube, axis)};
    }
  }

  const RidgeEvidence& evidence_;
  const DualComplex& complex_;
  const RidgeBounds& bounds_;
  ExecutionContext* context_;
  CellSet taken_;            // closed
  DisjointSets components_;  // of cubes
  std::vector<Stretch> short_ones_;
  RidgeAnchors result_;
};

}  // namespace

RidgeAnchors ridge_anchors(const RidgeEvidence& evidence, const RidgeBounds& bounds,
                           ExecutionContext* context) {
  require_within(bounds.low, 1e-6, 1000,
                 "the lower bound of a ridge's strength must lie between 1e-6 and 1000");
  require_within(bounds.high, bounds.low, 1e6,
                 "the higher bound of a ridge's strength must be at least the lower one");
  return Choice(evidence, bounds, context).run();
}

}  // namespace affskel::core
