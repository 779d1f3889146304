// Notation: places are the lattice points and one layer more around them, -1 to dims.  A place is *full* when
// it is a sample point with E >= level.  The cube from place (i, j, k) to (i + 1, j + 1, k + 1) has corners
// 0 to 7 = 4a + 2b + c at (i + a, j + b, k + c); its six tetrahedra have the corners 0, p, p | q, 7 with p
// and q different single bits, so every edge goes from a corner to one with more bits, by the step of
// LatticeCuts.
//
// Along an edge with a full end p, the eroded solid ends at the *stop* (p -> q) when q is not full or the
// surface of V leaves a gap in the edge (then both ends have a stop).  Walking round a side of a tetrahedron,
// the stops alternate between going in and coming out; each way in is joined to the next way out.  Both
// tetrahedra of a side do this alike, in opposite sense, and every stop of a tetrahedron is met on two of its
// sides, once in each sense: the joins close to loops, and discs in the loops to a closed manifold.  When the
// two stops of one edge are joined (the end of a gap), they are so by way of a *rim* vertex of that side,
// so that no two sides have a join in common.
//
// Where vertices lie.  A vertex is on an edge of the split between a full place and one that is not in the
// eroded solid, or that the surface of V cuts off from it: where E falls to the level or, where E has a limit
// above the level (at concave places), on the surface of V (level_crossing.h, lattice_cuts.h).  Two sample
// points above the level with a gap of V between them, however narrow, are thus not joined along their edge.
// Where E jumps, because chords begin to take in a limb more, the data leave a vertex open on its edge, and
// it moves to an even place among its neighbours (loose_vertices.h).  Short edges are collapsed onto one of
// their ends (tidy_mesh.h), so every vertex stays a crossing.  All that decides the shape happens in lattice
// coordinates.
//
// Measured on a ball of radius 1, the level's ball having the radius r: vertices lie within 0.02 spacings of
// it at the spacings 0.1 and 0.05 (0.05 within a spacing of the surface), and the volume falls short by at
// most 0.4 (spacing / r)^2 of itself.  On a torus of radii 2 and 0.7, levels of 0.001 to 0.03 v0, halving the
// spacing from 0.2 to 0.1 changes the volume by less than 2 %.
#include "core/surface/eroded_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/base/none.h"
#include "core/lattice/lattice_cuts.h"
#include "core/lattice/layer_index.h"
#include "core/surface/eroded_places.h"
#include "core/surface/level_crossing.h"
#include "core/tidy/loose_vertices.h"
#include "core/tidy/tidy_mesh.h"

namespace affskel::core {
namespace {

using Indices = std::array<std::int64_t, 3>;

/// The six tetrahedra, positively oriented: det(t1 - t0, t2 - t0, t3 - t0) > 0 in lattice coordinates.
constexpr std::array<std::array<unsigned, 4>, 6> kTetrahedra{
    {{0, 4, 6, 7}, {0, 2, 3, 7}, {0, 1, 5, 7}, {0, 5, 4, 7}, {0, 3, 1, 7}, {0, 6, 2, 7}}};
/// Their sides, counter-clockwise seen from outside.
constexpr std::array<std::array<std::size_t, 3>, 4> kSides{{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
/// Stops stay this far from the ends of their edge and from each other, so that no triangle is without area.
constexpr double kLevelMargin = 1e-3;

class Marcher {
 public:
  Marcher(const Solid& solid, const Lattice& lattice, const FrameField& field, double level,
          ExecutionContext* context)
      : field_(field),
        level_(level),
        context_(context),
        cuts_(solid, lattice, context),
        places_(lattice, field, cuts_, level),
        ranks_(lattice) {
    for (std::size_t a = 0; a < 3; ++a) dims_[a] = lattice.grid.dims[a];
  }

  /// In lattice coordinates.
  Mesh run() {
    for (at_[0] = -1; at_[0] < dims_[0]; ++at_[0]) {
      throw_if_stopped(context_);
      places_.move_to(at_[0]);
      if (at_[0] + 1 < dims_[0]) ranks_.move_to(static_cast<std::uint32_t>(at_[0] + 1));
      // clear() would touch all the buckets that the fullest layer needed.
      layers_[slot(at_[0] + 1)] = {};
      for (at_[1] = -1; at_[1] < dims_[1]; ++at_[1]) march_row();
    }
    constexpr int kRounds = 40;  // enough for steps of a few voxels
    relax_loose_vertices(loose_, kRounds, mesh_, context_);
    return std::move(mesh_);
  }

 private:
  using Names = std::unordered_map<std::uint64_t, std::uint32_t>;

  /// The vertices of the edges and sides that begin in a layer (i, *, *).
  struct Layer {
    Names stops, rims;  // by edge and end, by side and edge
  };

  struct Join {
    std::uint32_t from = 0, to = 0;
  };

  static std::size_t slot(std::int64_t i) { return static_cast<std::size_t>(i + 1) % 2; }

  Layer& layer(std::int64_t i) { return layers_[slot(i)]; }

  /// The cubes from places (at_[0], at_[1], *) with a full corner.
  void march_row() {
    std::array<ErodedPlaces::Row, 4> rows{};  // of the cubes' edges along axis 2, by 2a + b
    ErodedPlaces::Extent reach;
    for (unsigned r = 0; r < 4; ++r) {
      rows[r] = places_.row(at_[0] + (r >> 1), at_[1] + (r & 1));
      reach.take(rows[r].extent.first, rows[r].extent.last);
    }
    for (std::int64_t k = reach.first - 1; k <= reach.last; ++k) {
      unsigned any_gaps = 0;
      corner_full_ = 0;
      for (unsigned corner = 0; corner < 8; ++corner) {
        const std::int64_t n = k + (corner & 1);
        corner_full_ |= static_cast<unsigned>(rows[corner >> 1].full[n]) << corner;
        corner_gaps_[corner] = rows[corner >> 1].gaps[n];
        any_gaps |= corner_gaps_[corner];
      }
      if (corner_full_ == 0 || (corner_full_ == 0xFF && any_gaps == 0)) continue;
      at_[2] = k;
      for (const auto& tetrahedron : kTetrahedra) march_tetrahedron(tetrahedron);
    }
  }

  Indices place(unsigned corner) const {
    return {at_[0] + ((corner >> 2) & 1), at_[1] + ((corner >> 1) & 1), at_[2] + (corner & 1)};
  }

  bool full(unsigned corner) const { return ((corner_full_ >> corner) & 1U) != 0; }

  /// Whether the edge between two corners has a gap.
  bool has_gap(unsigned p, unsigned q) const { return ((corner_gaps_[p & q] >> (p ^ q)) & 1U) != 0; }

  void march_tetrahedron(const std::array<unsigned, 4>& t) {
    joins_.clear();
    has_rim_ = false;
    for (const auto& side : kSides) join_stops({t[side[0]], t[side[1]], t[side[2]]});
    while (!joins_.empty()) {
      std::vector<std::uint32_t>& loop = loop_;
      loop = {joins_.back().from};
      for (std::uint32_t to = joins_.back().to; to != loop.front();) {
        loop.push_back(to);
        to = std::find_if(joins_.begin(), joins_.end(), [&](const Join& j) { return j.from == to; })->to;
      }
      std::erase_if(joins_,
                    [&](const Join& j) { return std::find(loop.begin(), loop.end(), j.from) != loop.end(); });
      fill_loop();
    }
  }

  /// The joins of one side, its corners counter-clockwise seen from outside the tetrahedron.
  void join_stops(const std::array<unsigned, 3>& side) {
    std::array<std::uint32_t, 6> stops{};  // alternating: out, in, out, ... or in, out, in, ...
    std::size_t count = 0, gap_edges = 0, gap_edge = 0;
    bool first_is_in = false;
    for (std::size_t e = 0; e < 3; ++e) {
      const unsigned p = side[e], q = side[(e + 1) % 3];
      if (!full(p) && !full(q)) continue;
      if (full(p) && full(q)) {
        if (!has_gap(p, q)) continue;
        ++gap_edges;
        gap_edge = e;
      }
      if (count == 0) first_is_in = !full(p);
      if (full(p)) stops[count++] = stop(p, q);
      if (full(q)) stops[count++] = stop(q, p);
    }
    if (count == 2 && gap_edges == 1) {
      const std::uint32_t middle = rim(side, gap_edge);
      joins_.push_back({stops[1], middle});
      joins_.push_back({middle, stops[0]});
      has_rim_ = true;
      return;
    }
    for (std::size_t in = first_is_in ? 0 : 1; in < count; in += 2) {
      joins_.push_back({stops[in], stops[(in + 1) % count]});
    }
  }

  /// A disc in loop_.  The diagonal of a quadrangle that cuts two corners from two others is no edge of any
  /// other tetrahedron; in other loops that cannot be said, and a vertex in the middle is used.
  void fill_loop() {
    const std::vector<std::uint32_t>& q = loop_;
    if (q.size() == 3) {
      mesh_.triangles.push_back({q[0], q[1], q[2]});
    } else if (q.size() == 4 && !has_rim_) {
      const std::vector<Vec3>& at = mesh_.points;
      const bool first = squared_distance(at[q[0]], at[q[2]]) <= squared_distance(at[q[1]], at[q[3]]);
      mesh_.triangles.push_back(first ? Triangle{q[0], q[1], q[2]} : Triangle{q[0], q[1], q[3]});
      mesh_.triangles.push_back(first ? Triangle{q[0], q[2], q[3]} : Triangle{q[1], q[2], q[3]});
    } else {
      Vec3 sum;
      for (std::uint32_t v : q) sum = sum + mesh_.points[v];
      const std::uint32_t middle = add_vertex((1 / static_cast<double>(q.size())) * sum);
      for (std::size_t v = 0; v < q.size(); ++v) {
        mesh_.triangles.push_back({q[v], q[(v + 1) % q.size()], middle});
      }
    }
  }

  std::uint32_t add_vertex(const Vec3& x) {
    if (mesh_.points.size() >= 0xFFFFFFFFU) {
      throw CoreError(CoreError::Code::kLimit, "the eroded solid's surface has more than 2^32 vertices");
    }
    mesh_.points.push_back(x);
    return static_cast<std::uint32_t>(mesh_.points.size() - 1);
  }

  /// The vertex of the end of gap edge `e` in a side: a quarter of the way from the gap to the third corner.
  std::uint32_t rim(const std::array<unsigned, 3>& side, std::size_t e) {
    const unsigned p = side[e], q = side[(e + 1) % 3], other = side[(e + 2) % 3];
    const unsigned low = p & q & other, high = p | q | other, middle = p ^ q ^ other ^ low ^ high;
    const unsigned which = other == low ? 0 : other == high ? 1 : 2;
    const Indices at = place(low);
    const std::uint64_t key = cuts_.edge(at[0], at[1], at[2], high ^ low) * 32 + (middle ^ low) * 4 + which;
    const std::uint32_t a = stop(p, q), b = stop(q, p);
    const auto [name, is_new] = layer(at[0]).rims.try_emplace(key, 0U);
    if (is_new) {
      const Vec3 gap = 0.5 * (mesh_.points[a] + mesh_.points[b]);
      name->second = add_vertex(gap + 0.25 * (vector_of(place(other)) - gap));
    }
    return name->second;
  }

  /// The vertex where the eroded solid ends on the way from corner p, which is full, to corner q.
  std::uint32_t stop(unsigned p, unsigned q) {
    const unsigned low = p & q;
    const Indices at = place(low);
    const std::uint64_t edge = cuts_.edge(at[0], at[1], at[2], p ^ q);
    const auto [name, is_new] = layer(at[0]).stops.try_emplace(edge * 2 + (p == low ? 0 : 1), 0U);
    if (is_new) name->second = add_stop(p, q, cuts_.find(edge));
    return name->second;
  }

  std::uint32_t add_stop(unsigned p, unsigned q, const LatticeCut* cut) {
    LevelCrossing found = crossing(p, q, cut);
    double max_share = 1 - kLevelMargin;
    if (full(q)) {  // stay on this side of the gap
      const double gap = std::clamp((cut->leaves + cut->enters) / 2, 3 * kLevelMargin, 1 - 3 * kLevelMargin);
      max_share = (p == (p & q) ? gap : 1 - gap) - kLevelMargin;
    }
    for (double* t : {&found.share, &found.min_share, &found.max_share})
      *t = std::clamp(*t, kLevelMargin, max_share);
    const Indices from = place(p), to = place(q);
    const Vec3 start = vector_of(from), along = vector_of(to) - start;
    const std::uint32_t vertex = add_vertex(start + found.share * along);
    if (found.min_share < found.max_share) {
      loose_.push_back({vertex, start, along, found.min_share, found.max_share, found.share});
    }
    return vertex;
  }

  LevelCrossing crossing(unsigned p, unsigned q, const LatticeCut* cut) const {
    const std::uint32_t x = rank(p), y = rank(q);
    const Vec3 delta = field_.spacing * (vector_of(place(q)) - vector_of(place(p)));
    const Vec3& g = field_.gradient[x];
    const EdgeValue here{field_.erosion[x], dot(g, delta)};
    if (y == kNone || has_gap(p, q)) {
      // Without a cut, p and q disagree about the surface by rounding, and it is near one of them.
      const double surface = cut == nullptr ? 1 : p == (p & q) ? cut->leaves : 1 - cut->enters;
      const double t = level_crossing_before_surface(here, surface, level_);
      return {t, t, t};
    }
    const Vec3& h = field_.gradient[y];
    constexpr double kMaxCosine = 0.5;  // see level_crossing_between
    const bool kinked = dot(g, h) < kMaxCosine * norm(g) * norm(h);
    return level_crossing_between(here, {field_.erosion[y], dot(h, delta)}, level_, kinked);
  }

  std::uint32_t rank(unsigned corner) const {
    const Indices at = place(corner);
    return ranks_.at(at[0], at[1], at[2]);
  }

  const FrameField& field_;
  double level_;
  ExecutionContext* context_;
  LatticeCuts cuts_;
  ErodedPlaces places_;
  LayerIndex ranks_;  // of layer at_[0] + 1 and the two beside it
  Indices dims_{};
  std::array<Layer, 2> layers_;
  // The cube in hand.
  Indices at_{};
  unsigned corner_full_ = 0;
  std::array<std::uint8_t, 8> corner_gaps_{};
  // The tetrahedron in hand.
  std::vector<Join> joins_;
  std::vector<std::uint32_t> loop_;
  bool has_rim_ = false;
  Mesh mesh_;
  std::vector<LooseVertex> loose_;
};

void check(const Lattice& lattice, const FrameField& field, const ErodedSurfaceOptions& options) {
  if (!(std::isfinite(options.level) && options.level >= 0)) {
    refuse("eroded solid: the level must be a finite number >= 0, not " + base::to_text(options.level));
  }
  if (!(options.shortest_edge >= 0 && options.shortest_edge < 1)) {
    refuse("eroded solid: the shortest edge must be >= 0 and < 1 spacing, not " +
           base::to_text(options.shortest_edge));
  }
  if (field.erosion.size() != lattice.points || field.gradient.size() != lattice.points) {
    refuse("eroded solid: the field has " + std::to_string(field.erosion.size()) + " points, the lattice " +
           std::to_string(lattice.points));
  }
}

/// From lattice coordinates to mesh units, outward also when the lattice's axes are left-handed.
void place_mesh(const Solid& solid, const Lattice& lattice, Mesh& mesh) {
  const SamplePlaces places(solid, lattice);
  const std::array<Vec3, 3>& axes = places.axes();
  for (Vec3& p : mesh.points) p = places.origin() + (p.x * axes[0] + (p.y * axes[1] + p.z * axes[2]));
  if (dot(axes[0], cross(axes[1], axes[2])) < 0) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  }
}

}  // namespace

std::vector<std::uint32_t> eroded_points(const FrameField& field, double level) {
  std::vector<std::uint32_t> ranks;
  for (std::uint32_t p = 0; p < field.erosion.size(); ++p) {
    if (field.erosion[p] >= level) ranks.push_back(p);
  }
  return ranks;
}

ErodedSurface eroded_surface(const Solid& solid, const Lattice& lattice, const FrameField& field,
                             const ErodedSurfaceOptions& options) {
  check(lattice, field, options);
  ErodedSurface result;
  result.mesh = Marcher(solid, lattice, field, options.level, options.context).run();
  throw_if_stopped(options.context);
  if (options.shortest_edge > 0) result.mesh = tidy_mesh(result.mesh, options.shortest_edge, options.context);
  result.values = field_between(lattice, field, result.mesh.points);
  place_mesh(solid, lattice, result.mesh);
  result.volume = enclosed_volume(result.mesh);
  return result;
}

}  // namespace affskel::core
