// Notation (design section 2).  d: the direction; h(y) = d.y; ranks order the vertices by height.  A triangle
// T has corners of rank lo < mid < hi at heights a <= b <= c, and p = -d.a_T, a_T its outward area vector.
// The share f_T(t) of T below t is quadratic between the heights, and A(t) = sum p_T f_T(t) is the area of
// the section, V(t) its integral.  f_T starts at a, bends at b and ends at c with f and f' continuous, so
//   f_T'' / 2 jumps by  1/((b-a)(c-a)),  -1/((b-a)(c-a)) - 1/((c-b)(c-a)),  1/((c-b)(c-a))  at a, b, c:
// per vertex only the bend of A changes.  Bends of nearly level triangles are huge and must cancel exactly
// later; they, and all running coefficients, are kept as unevaluated sums of two doubles ("hi + lo").
#include "core/join_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/height_order.h"
#include "core/tree_input.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A triangle lower than this (inner units; the solid's size is 1) is a jump of A at its top, an edge a jump
// of A'.  V is exact above them and off by less than p times this inside their height range.  Smaller
// values cost accuracy too: bends reach p / kLevel^2, of which the double-double sums keep 2^-104.
constexpr double kLevel = 1e-11;
// Bends up to this times v0 are added in plain doubles: 2^-53 of it, integrated three times over the height
// of the solid (at most 1.8 inner units), is less than 1e-12 v0.
constexpr double kPlainBend = 4000;
struct Sum2 {
  double hi = 0, lo = 0;

  void add(double value, double low = 0) {
    const double sum = hi + value, rounded = sum - hi;
    lo += ((hi - (sum - rounded)) + (value - rounded)) + low;
    hi = sum;
  }
  void add(const Sum2& other) { add(other.hi, other.lo); }
  double value() const { return hi + lo; }
};

// num / (a b), all exact doubles.
inline Sum2 quotient(double num, double a, double b) {
  const double product = a * b, product_low = std::fma(a, b, -product);
  const double hi = num / product;
  return {hi, (std::fma(-hi, product, num) - hi * product_low) / product};
}

inline Sum2 times(const Sum2& s, double factor) {
  const double hi = s.hi * factor;
  return {hi, std::fma(s.hi, factor, -hi) + s.lo * factor};
}

// Sudden changes at one vertex, from level triangles and edges.
struct Jump {
  std::uint32_t rank = 0;
  double volume = 0;
  double area = 0;
  Sum2 slope;
};

// Running coefficients of one component, about `height`: A(t) = area + slope s + bend s^2.
struct Running {
  double height = 0;
  Sum2 volume, area, slope, bend;
};

inline void advance(Running& r, double height) {
  const double s = height - r.height;
  if (s == 0) return;
  const double slope = r.slope.value();
  r.volume.add(s * (r.area.value() + s * (0.5 * slope + s * (r.bend.value() / 3))));
  const Sum2 rise = times(r.bend, s);  // half of what the slope gains
  Sum2 middle = r.slope;
  middle.add(rise);
  r.area.add(times(middle, s));
  middle.add(rise);
  r.slope = middle;
  r.height = height;
}

inline void add(Running& sum, const Running& other) {
  sum.volume.add(other.volume);
  sum.area.add(other.area);
  sum.slope.add(other.slope);
  sum.bend.add(other.bend);
}

struct Ranked {
  std::uint32_t lo, mid, hi;
};

inline Ranked sort3(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const std::uint32_t lo = std::min(std::min(a, b), c), hi = std::max(std::max(a, b), c);
  return {lo, a ^ b ^ c ^ lo ^ hi, hi};
}

// What the pass over the triangles leaves per vertex, by rank.
struct VertexData {
  std::vector<double> plain_bend;   // of A'', the moderate part
  std::vector<Sum2> bend;           // and the rest: huge parts would swallow moderate ones added to them
  std::vector<std::uint32_t> down;  // some lower neighbour, kNone at a minimum
  std::vector<std::uint8_t>
      middles;  // triangles of which it is the middle corner: 2 per lower link component
  std::vector<std::uint32_t> lowest;  // per triangle: rank of its lowest corner
  std::vector<Jump> jumps;
};

inline void add_level_triangle(const Ranked& r, double a, double b, double c, double p, VertexData& out) {
  out.jumps.push_back({r.hi, p * (c - (a + b + c) / 3), p, {}});
}

inline void add_level_low_edge(const Ranked& r, double a, double b, double c, double p, VertexData& out) {
  const Sum2 bend = quotient(p, c - b, c - b);
  out.bend[r.mid].add(-bend.hi, -bend.lo);
  out.bend[r.hi].add(bend);
  out.jumps.push_back({r.mid, p * (b - a) / 3, 0, times(bend, 2 * (c - b))});
}

inline void add_level_high_edge(const Ranked& r, double a, double b, double c, double p, VertexData& out) {
  const Sum2 bend = quotient(p, b - a, b - a);
  out.bend[r.lo].add(bend);
  out.bend[r.mid].add(-bend.hi, -bend.lo);
  out.jumps.push_back({r.mid, -p * (c - b) / 3, 0, times(bend, -2 * (b - a))});
}

__attribute__((always_inline)) inline void add_exactly(const Ranked& r, double a, double b, double c,
                                                       double p, VertexData& out) {
  const Sum2 start = quotient(p, b - a, c - a), end = quotient(p, c - b, c - a);
  out.bend[r.lo].add(start);
  out.bend[r.mid].add(-start.hi, -start.lo);
  out.bend[r.mid].add(-end.hi, -end.lo);
  out.bend[r.hi].add(end);
}

void pass_triangles(const TreeInput::Data& input, const HeightOrder& heights, const Vec3& d,
                    VertexData& out) {
  const std::vector<Triangle>& triangles = input.solid.mesh.triangles;
  const std::uint32_t* rank = heights.rank().data();
  const double* height = heights.height().data();
  const double plain = kPlainBend * input.volume;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Ranked r = sort3(rank[triangles[t][0]], rank[triangles[t][1]], rank[triangles[t][2]]);
    out.lowest[t] = r.lo;
    out.down[r.mid] = r.lo;
    out.down[r.hi] = r.lo;
    out.middles[r.mid] = static_cast<std::uint8_t>(std::min(out.middles[r.mid] + 1, 254));
    const double a = height[r.lo], b = height[r.mid], c = height[r.hi];
    const double p = -dot(d, input.area_vector[t]);
    const double ba = b - a, cb = c - b, ca = c - a;
    const double start = p / (ba * ca), end = p / (cb * ca);
    if (std::abs(start) <= plain && std::abs(end) <= plain && ba > kLevel && cb > kLevel) {
      out.plain_bend[r.lo] += start;
      out.plain_bend[r.mid] -= start + end;
      out.plain_bend[r.hi] += end;
    } else if (ca <= kLevel) {
      add_level_triangle(r, a, b, c, p, out);
    } else if (ba <= kLevel) {
      add_level_low_edge(r, a, b, c, p, out);
    } else if (cb <= kLevel) {
      add_level_high_edge(r, a, b, c, p, out);
    } else {
      add_exactly(r, a, b, c, p, out);
    }
  }
}

// The arcs as the topology pass finds them.
struct Topology {
  std::vector<std::uint32_t> vertex_arc;      // by rank
  std::vector<std::uint32_t> start_rank;      // per arc: the vertex it starts at
  std::vector<std::uint32_t> piece_count;     // per arc
  std::vector<std::uint32_t> arc_solid;       // per arc
  std::vector<std::uint32_t> children_begin;  // per arc and one more
  std::vector<std::uint32_t> children;
  std::vector<std::uint32_t> current;  // union-find: towards the arc that now holds this one
};

double pass_volumes(const HeightOrder& heights, const VertexData& vertices, const Topology& topology,
                    std::vector<Running>& running, JoinTree& tree) {
  const std::vector<double>& height = heights.height();
  double least_step = 0;
  auto jump = vertices.jumps.begin();
  for (std::uint32_t r = 0; r < height.size(); ++r) {
    const std::uint32_t a = topology.vertex_arc[r];
    Running& state = running[a];
    const double before = state.volume.value();
    if (topology.start_rank[a] == r) {
      state = {height[r], {}, {}, {}, {}};
      for (std::uint32_t i = topology.children_begin[a]; i < topology.children_begin[a + 1]; ++i) {
        advance(running[topology.children[i]], height[r]);
        add(state, running[topology.children[i]]);
      }
    } else {
      advance(state, height[r]);
    }
    state.bend.add(vertices.bend[r]);
    state.bend.add(vertices.plain_bend[r]);
    for (; jump != vertices.jumps.end() && jump->rank == r; ++jump) {
      state.volume.add(jump->volume);
      state.area.add(jump->area);
      state.slope.add(jump->slope);
    }
    const double volume = state.volume.value();
    if (topology.start_rank[a] != r) least_step = std::min(least_step, volume - before);
    Arc& arc = tree.arcs[a];
    if (topology.start_rank[a] != r && tree.pieces[arc.last_piece].height != height[r]) ++arc.last_piece;
    tree.pieces[arc.last_piece] = {height[r], volume, state.area.value(), 0.5 * state.slope.value(),
                                   state.bend.value() / 3};
  }
  return least_step;
}

}  // namespace

class JoinTreeBuilder::Work {
 public:
  Work(const TreeInput& input, const JoinTreeOptions& options)
      : input_(input.data()),
        tolerance_(input.volume_tolerance()),
        options_(options),
        heights_(input_.solid.mesh.points) {
    const std::size_t vertices = input_.solid.mesh.points.size(),
                      triangles = input_.solid.mesh.triangles.size();
    vertex_.lowest.resize(triangles);
    topology_.vertex_arc.resize(vertices);
    tree_.triangle_arc.resize(triangles);
    tree_.pieces.resize(vertices);
  }

  const JoinTree& run(const Vec3& d) {
    d_ = d;
    heights_.sort(d);
    reset();
    pass_triangles(input_, heights_, d, vertex_);
    std::stable_sort(vertex_.jumps.begin(), vertex_.jumps.end(),
                     [](const Jump& a, const Jump& b) { return a.rank < b.rank; });
    find_arcs();
    lay_out_pieces();
    running_.resize(tree_.arcs.size());
    tree_.least_step = pass_volumes(heights_, vertex_, topology_, running_, tree_);
    fill_cells();
    for (std::size_t t = 0; t < vertex_.lowest.size(); ++t) {
      tree_.triangle_arc[t] = topology_.vertex_arc[vertex_.lowest[t]];
    }
    if (options_.check_invariants) check();
    return tree_;
  }

 private:
  void reset() {
    const std::size_t vertices = heights_.order().size();
    vertex_.bend.assign(vertices, {});
    vertex_.plain_bend.assign(vertices, 0);
    vertex_.down.assign(vertices, kNone);
    vertex_.middles.assign(vertices, 0);
    vertex_.jumps.clear();
    tree_.arcs.clear();
    topology_.start_rank.clear();
    topology_.piece_count.clear();
    topology_.arc_solid.clear();
    topology_.children.clear();
    topology_.children_begin.assign(1, 0);
    topology_.current.clear();
  }

  std::uint32_t find(std::uint32_t arc) {
    std::vector<std::uint32_t>& current = topology_.current;
    while (current[arc] != arc) {
      current[arc] = current[current[arc]];
      arc = current[arc];
    }
    return arc;
  }

  std::uint32_t arc_of(std::uint32_t rank) { return find(topology_.vertex_arc[rank]); }

  void find_arcs() {
    for (std::uint32_t r = 0; r < heights_.order().size(); ++r) {
      std::uint32_t arc = 0;
      if (vertex_.down[r] == kNone) {
        arc = at_minimum(r);
      } else if (vertex_.middles[r] <= 2) {
        arc = arc_of(vertex_.down[r]);
      } else {
        arc = at_saddle(r);
      }
      topology_.vertex_arc[r] = arc;
      ++topology_.piece_count[arc];
    }
  }

  std::uint32_t new_arc(std::uint32_t rank, std::uint32_t solid) {
    const auto arc = static_cast<std::uint32_t>(tree_.arcs.size());
    tree_.arcs.emplace_back();
    tree_.arcs.back().top = kInfinity;
    topology_.start_rank.push_back(rank);
    topology_.piece_count.push_back(0);
    topology_.arc_solid.push_back(solid);
    topology_.current.push_back(arc);
    topology_.children_begin.push_back(static_cast<std::uint32_t>(topology_.children.size()));
    return arc;
  }

  // The star of v lies above it, so v is the point of the star closest to v - s d, and the
  // angle-weighted pseudonormal tells whether that is outside (Baerentzen & Aanaes 2005, theorem 1): then
  // the solid lies above and a component is born.
  std::uint32_t at_minimum(std::uint32_t r) {
    const std::uint32_t v = heights_.order()[r];
    if (dot(input_.pseudonormal[v], d_) < 0) return new_arc(r, input_.vertex_solid[v]);
    const std::uint32_t below =
        input_.rays.first_exit_below(v, d_, [&](std::uint32_t t) { return vertex_.lowest[t] < r; });
    if (below != RayShooter::kNone) return arc_of(vertex_.lowest[below]);
    if (options_.check_invariants) {
      throw CoreError(CoreError::Code::kInternal, "direction " + in_words(d_) +
                                                      ": no surface below the inner minimum at vertex " +
                                                      std::to_string(v));
    }
    return new_arc(r, input_.vertex_solid[v]);
  }

  std::uint32_t at_saddle(std::uint32_t r) {
    meeting_.clear();
    for (std::uint32_t t : input_.fan(heights_.order()[r])) {
      if (vertex_.lowest[t] != r) meeting_.push_back(arc_of(vertex_.lowest[t]));
    }
    std::sort(meeting_.begin(), meeting_.end());
    meeting_.erase(std::unique(meeting_.begin(), meeting_.end()), meeting_.end());
    if (meeting_.size() == 1) return meeting_[0];
    topology_.children.insert(topology_.children.end(), meeting_.begin(), meeting_.end());
    const std::uint32_t arc = new_arc(r, topology_.arc_solid[meeting_[0]]);
    for (std::uint32_t child : meeting_) {
      tree_.arcs[child].top = heights_.height()[r];
      tree_.arcs[child].parent = arc;
      topology_.current[child] = arc;
    }
    return arc;
  }

  void lay_out_pieces() {
    std::uint32_t next = 0;
    tree_.roots = 0;
    for (std::size_t a = 0; a < tree_.arcs.size(); ++a) {
      tree_.arcs[a].first_piece = tree_.arcs[a].last_piece = next;
      next += topology_.piece_count[a];
      tree_.roots += tree_.arcs[a].parent == Arc::kNone;
    }
  }

  // Cells of equal height, as many as pieces.  Entry c: the last piece in a cell before c, else the first
  // piece; one entry more after the last cell: the last piece.
  void fill_cells() {
    tree_.cells.resize(tree_.pieces.size() + tree_.arcs.size());
    tree_.cell_volume.resize(tree_.cells.size());
    for (std::size_t a = 0; a < tree_.arcs.size(); ++a) {
      Arc& arc = tree_.arcs[a];
      const std::uint32_t last = arc.last_piece - arc.first_piece;
      const Piece* pieces = &tree_.pieces[arc.first_piece];
      const double span = pieces[last].height - pieces[0].height;
      arc.bottom = pieces[0].height;
      arc.first_cell = arc.first_piece + static_cast<std::uint32_t>(a);
      arc.cell_scale = span > 0 ? last / span : 0;
      std::uint32_t* entry = &tree_.cells[arc.first_cell];
      double* volume = &tree_.cell_volume[arc.first_cell];
      std::uint32_t filled = 0;
      for (std::uint32_t i = 0; i <= last; ++i) {
        const std::uint32_t own = JoinTree::cell(arc, pieces[i].height) - arc.first_cell;
        const std::uint32_t before = i == 0 ? 0 : i - 1;
        for (; filled <= own; ++filled) {
          entry[filled] = arc.first_piece + before;
          volume[filled] = pieces[before].volume;
        }
      }
      for (; filled <= last + 1; ++filled) {
        entry[filled] = arc.last_piece;
        volume[filled] = pieces[last].volume;
      }
    }
  }

  void check() const {
    if (tree_.roots != input_.solid_volume.size()) {
      throw_invariant(std::to_string(tree_.roots) + " roots for " +
                      std::to_string(input_.solid_volume.size()) + " solids");
    }
    if (tree_.least_step < -tolerance_) {
      throw_invariant("the volume falls by " + std::to_string(-tree_.least_step / input_.volume) +
                      " v0 along an arc");
    }
    for (std::size_t a = 0; a < tree_.arcs.size(); ++a) {
      if (tree_.arcs[a].parent != Arc::kNone) continue;
      const double volume = tree_.pieces[tree_.arcs[a].last_piece].volume;
      const double expected = input_.solid_volume[topology_.arc_solid[a]];
      if (!(std::abs(volume - expected) <= tolerance_)) {
        throw_invariant("the tree of solid " + std::to_string(topology_.arc_solid[a]) + " holds " +
                        std::to_string(volume / expected) + " of its volume");
      }
    }
  }

  static std::string in_words(const Vec3& d) {
    return "(" + std::to_string(d.x) + ", " + std::to_string(d.y) + ", " + std::to_string(d.z) + ")";
  }

  [[noreturn]] void throw_invariant(const std::string& what) const {
    throw CoreError(CoreError::Code::kInternal,
                    "join tree invariant broken for direction " + in_words(d_) + ": " + what);
  }

  const TreeInput::Data& input_;
  double tolerance_;
  JoinTreeOptions options_;
  Vec3 d_;
  HeightOrder heights_;
  VertexData vertex_;
  Topology topology_;
  std::vector<Running> running_;
  std::vector<std::uint32_t> meeting_;
  JoinTree tree_;
};

JoinTreeBuilder::JoinTreeBuilder(const TreeInput& input, const JoinTreeOptions& options)
    : work_(std::make_unique<Work>(input, options)) {}
JoinTreeBuilder::~JoinTreeBuilder() = default;

const JoinTree& JoinTreeBuilder::build(const Vec3& d) {
  return work_->run(d);
}

}  // namespace affskel::core
