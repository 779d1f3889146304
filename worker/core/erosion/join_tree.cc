// Notation (see README.md in worker/core).  d: the direction; h(y) = d.y; ranks order the vertices by height.
// A(t) is the area of a component's section at height t, V(t) its integral, the component's volume below t.
// A is quadratic between vertices; section_bends prepares what changes at them.
//
// Why the surface alone is enough.  Components of the solid merge only at points of its boundary, where the
// surfaces merge, too.  Below an inner minimum, the line segment to the point that its ray meets stays in V:
// so both lie in one component.
//
// A surface that crosses itself bounds the region that it winds round at least once, with overlaps counted
// twice in volumes.  Its components are joined where triangles cross (at_crossing) and where one is born
// inside another (nested minima, which are treated as inner minima).
#include "core/erosion/join_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/erosion/height_order.h"
#include "core/erosion/section_bends.h"

namespace affskel::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kThinRim = 1e-9;  // radians: what angle-weighted normals sum up to
// Small trees get about this many bins in all: filling them costs less than the chords they save.
constexpr std::uint32_t kMinBins = 1024;
// Vertices are prefetched this many ahead: in the order of their heights they are scattered over memory.
constexpr std::uint32_t kAhead = 16;

// The exact A' and A'' / 2 of one component at its last cubic, which holds them rounded.  Nearly level
// triangles make these two huge until they cancel; A and V stay moderate, and need no second double.
struct Running {
  DoubleSum slope, bend;
};

// Moves a component from its last cubic up to `height`: adds volume and area to `sum`, the derivatives to
// `exact`.
inline void advance(const Running& running, const Cubic& last, double height, Cubic& sum, Running& exact) {
  sum.volume += last.volume_at(height);
  sum.area += last.area_at(height);
  exact.slope.add(running.slope);
  exact.slope.add(times(running.bend, 2 * (height - last.height)));
  exact.bend.add(running.bend);
}

// The arcs as the topology pass finds them.
struct Topology {
  std::vector<std::uint32_t> vertex_arc;      // per vertex
  std::vector<std::uint32_t> start_rank;      // per arc: the vertex it starts at
  std::vector<std::uint32_t> cubic_count;     // per arc
  std::vector<std::uint32_t> arc_solid;       // per arc
  std::vector<std::uint32_t> children_begin;  // per arc and one more
  std::vector<std::uint32_t> children;
  std::vector<std::uint32_t> current;  // union-find: towards the arc that now holds this one
};

// Adds up the coefficients vertex by vertex and writes the cubics; returns the most negative change of a
// volume.
double pass_volumes(const std::vector<std::uint32_t>& order, const SectionBends& bends,
                    const Topology& topology, std::vector<Running>& running, JoinTree& tree) {
  constexpr double kThird = 1.0 / 3;
  double min_volume_change = 0;
  auto jump = bends.jumps.begin();
  for (std::uint32_t r = 0; r < order.size(); ++r) {
    if (r + kAhead < order.size()) {
      bends.prefetch(order[r + kAhead]);
      __builtin_prefetch(&topology.vertex_arc[order[r + kAhead]]);
    }
    const SectionBends::Vertex& vertex = bends.vertices[order[r]];
    const std::uint32_t a = topology.vertex_arc[order[r]];
    Arc& arc = tree.arcs[a];
    Cubic cubic{.height = vertex.height};
    Running exact;
    double before = -kInfinity;
    if (topology.start_rank[a] == r) {
      for (std::uint32_t i = topology.children_begin[a]; i < topology.children_begin[a + 1]; ++i) {
        const std::uint32_t child = topology.children[i];
        advance(running[child], tree.cubics[tree.arcs[child].last_cubic], vertex.height, cubic, exact);
      }
    } else {
      const Cubic& last = tree.cubics[arc.last_cubic];
      advance(running[a], last, vertex.height, cubic, exact);
      before = last.volume;
      arc.last_cubic += last.height != vertex.height ? 1 : 0;
    }
    exact.bend.add(vertex.bend[0], vertex.bend[1]);
    const std::uint32_t steep = bends.links[order[r]].steep;
    if (steep != kNone) exact.bend.add(bends.steep_bend[steep]);
    for (; jump != bends.jumps.end() && jump->rank == r; ++jump) {
      cubic.volume += jump->volume;
      cubic.area += jump->area;
      exact.slope.add(jump->slope);
    }
    cubic.half_slope = 0.5 * exact.slope.value();
    cubic.sixth_bend = kThird * exact.bend.value();
    min_volume_change = std::min(min_volume_change, cubic.volume - before);
    running[a] = exact;
    tree.cubics[arc.last_cubic] = cubic;
  }
  return min_volume_change;
}

}  // namespace

class JoinTreeBuilder::Work {
 public:
  Work(const TreeInput& input, const JoinTreeOptions& options)
      : input_(input), tolerance_(input.volume_tolerance()), options_(options), heights_(input_.mesh.points) {
    const std::size_t vertices = input_.mesh.points.size(), triangles = input_.mesh.triangles.size();
    topology_.vertex_arc.resize(vertices);
    tree_.triangle_arc.resize(triangles);
    tree_.cubics.resize(vertices);
  }

  const JoinTree& run(const Vec3& d) {
    d_ = d;
    heights_.sort(d);
    reset();
    find_section_bends(input_, heights_, d, vertex_);
    find_arcs();
    lay_out_cubics();
    running_.resize(tree_.arcs.size());
    tree_.min_volume_change = pass_volumes(heights_.order(), vertex_, topology_, running_, tree_);
    fill_bins();
    if (options_.crosses_itself) lower_bins();
    for (std::size_t t = 0; t < vertex_.lowest.size(); ++t) {
      tree_.triangle_arc[input_.original_triangle[t]] = topology_.vertex_arc[vertex_.lowest[t]];
    }
    if (!options_.crosses_itself) check();
    return tree_;
  }

 private:
  void reset() {
    tree_.arcs.clear();
    topology_.start_rank.clear();
    topology_.cubic_count.clear();
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

  std::uint32_t arc_of(std::uint32_t vertex) { return find(topology_.vertex_arc[vertex]); }

  // Whether the triangle begins below rank r.
  bool begins_below(std::uint32_t triangle, std::uint32_t r) const {
    return vertex_.vertices[vertex_.lowest[triangle]].rank < r;
  }

  void find_arcs() {
    const std::vector<std::uint32_t>& order = heights_.order();
    for (std::uint32_t r = 0; r < order.size(); ++r) {
      if (r + kAhead < order.size()) {
        vertex_.prefetch(order[r + kAhead]);
        __builtin_prefetch(&topology_.vertex_arc[order[r + kAhead]], 1);
      }
      const std::uint32_t v = order[r];
      const SectionBends::Vertex& vertex = vertex_.vertices[v];
      std::uint32_t arc = 0;
      if (input_.at_crossing(v)) {
        arc = at_crossing(r);
      } else if (vertex.down == kNone) {
        arc = at_minimum(r);
      } else if (vertex_.links[v].middles <= 2) {
        arc = arc_of(vertex.down);
      } else {
        gather_fan(r);
        arc = join_meeting(r);
      }
      topology_.vertex_arc[v] = arc;
      ++topology_.cubic_count[arc];
    }
  }

  std::uint32_t new_arc(std::uint32_t rank, std::uint32_t solid) {
    const auto arc = static_cast<std::uint32_t>(tree_.arcs.size());
    tree_.arcs.emplace_back();
    tree_.arcs.back().top = kInfinity;
    topology_.start_rank.push_back(rank);
    topology_.cubic_count.push_back(0);
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
    const bool nested = !input_.nested.empty() && input_.nested[v] != 0;
    const double up = -dot(input_.pseudonormal[v], d_);
    if (up > 0 && !nested) return new_arc(r, input_.vertex_solid[v]);
    const std::uint32_t below =
        input_.rays.first_exit_below(v, d_, [&](std::uint32_t t) { return begins_below(t, r); });
    if (below != kNone) return arc_of(vertex_.lowest[below]);
    // At the rim of a thin plate the normals of its two sides cancel but for rounding.
    const bool undecided = up > -kThinRim;
    if (!options_.crosses_itself && !undecided) {
      throw CoreError(CoreError::Code::kInternal, "direction " + in_words(d_) +
                                                      ": no surface below the inner minimum at vertex " +
                                                      std::to_string(input_.original_vertex[v]));
    }
    return new_arc(r, input_.vertex_solid[v]);
  }

  // Where two triangles cross, the regions on both sides are one.  They are joined at the higher of the two
  // triangles' lowest corners: only triangles that begin at v can cross one that is not joined with them yet.
  // That is early by at most a triangle's height.  Single chords become too large, which other directions put
  // right; none becomes too small, which nothing would.
  std::uint32_t at_crossing(std::uint32_t r) {
    const std::uint32_t v = heights_.order()[r];
    gather_fan(r);
    for (std::uint32_t t : input_.fan(v)) {
      if (vertex_.lowest[t] != v) continue;
      for (std::uint32_t other : input_.crossing(t)) {
        if (begins_below(other, r)) meeting_.push_back(arc_of(vertex_.lowest[other]));
      }
    }
    return meeting_.empty() ? at_minimum(r) : join_meeting(r);
  }

  void gather_fan(std::uint32_t r) {
    meeting_.clear();
    const std::uint32_t v = heights_.order()[r];
    for (std::uint32_t t : input_.fan(v)) {
      if (vertex_.lowest[t] != v) meeting_.push_back(arc_of(vertex_.lowest[t]));
    }
  }

  // Where a lattice row passes through v, one leg's points come before it and the other's behind it, all at its
  // height.  Joined too late, a point would get the leg that the row comes from in place of its own, and no
  // other direction would put it right.
  std::uint32_t join_meeting(std::uint32_t r) {
    std::sort(meeting_.begin(), meeting_.end());
    meeting_.erase(std::unique(meeting_.begin(), meeting_.end()), meeting_.end());
    if (meeting_.size() == 1) return meeting_[0];
    topology_.children.insert(topology_.children.end(), meeting_.begin(), meeting_.end());
    const std::uint32_t arc = new_arc(r, topology_.arc_solid[meeting_[0]]);
    for (std::uint32_t child : meeting_) {
      tree_.arcs[child].top = heights_.height()[r] - HeightOrder::kUnit;
      tree_.arcs[child].parent = arc;
      topology_.current[child] = arc;
    }
    return arc;
  }

  void lay_out_cubics() {
    std::uint32_t next = 0;
    tree_.roots = 0;
    for (std::size_t a = 0; a < tree_.arcs.size(); ++a) {
      tree_.arcs[a].first_cubic = tree_.arcs[a].last_cubic = next;
      next += topology_.cubic_count[a];
      tree_.roots += tree_.arcs[a].parent == kNone;
    }
  }

  // As many bins as cubics or, in small trees, a multiple of that.  Entry c: the last cubic that begins in a
  // bin before c, or the first cubic; it therefore reaches up to where bin c begins.  One more entry after
  // the last bin: the last cubic.
  void fill_bins() {
    const auto cubics = static_cast<std::uint32_t>(tree_.cubics.size());
    const std::uint32_t bins_per_cubic = cubics < kMinBins ? kMinBins / cubics : 1;
    tree_.bins.resize(std::size_t{cubics} * bins_per_cubic + 2 * tree_.arcs.size());
    tree_.bin_volume.resize(tree_.bins.size());
    std::uint32_t next = 0;
    for (Arc& arc : tree_.arcs) {
      arc.first_bin = next;
      arc.last_bin = next + (arc.last_cubic - arc.first_cubic) * bins_per_cubic;
      fill_bins(arc);
      next = arc.last_bin + 2;
    }
  }

  // Without a branch, for the processor could not predict how many cubics fall into a bin.
  void fill_bins(Arc& arc) {
    const std::uint32_t last = arc.last_cubic - arc.first_cubic, last_bin = arc.last_bin - arc.first_bin;
    const Cubic* cubics = &tree_.cubics[arc.first_cubic];
    const double span = cubics[last].height - cubics[0].height;
    arc.bottom = cubics[0].height;
    arc.bin_scale = span > 0 ? last_bin / span : 0;
    const double side = span > 0 ? span / last_bin : 0;
    std::uint32_t* entry = &tree_.bins[arc.first_bin];
    double* volume = &tree_.bin_volume[arc.first_bin];
    std::fill(entry, entry + last_bin + 2, 0);
    for (std::uint32_t i = 0; i <= last; ++i) {
      entry[JoinTree::bin(arc, cubics[i].height) - arc.first_bin + 1] = i;
    }
    std::uint32_t before = 0;
    for (std::uint32_t c = 0; c <= last_bin; ++c) {
      before = std::max(before, entry[c]);
      entry[c] = arc.first_cubic + before;
      volume[c] = cubics[before].volume_at(std::min(arc.bottom + c * side, cubics[last].height));
    }
    entry[last_bin + 1] = arc.last_cubic;
    volume[last_bin + 1] = cubics[last].volume;
  }

  // Where volumes may fall, the volume of a bin becomes the least one from there up to the root.
  void lower_bins() {
    for (std::size_t a = tree_.arcs.size(); a-- > 0;) {  // parents before their children
      const Arc& arc = tree_.arcs[a];
      const bool root = arc.parent == kNone;
      double least = root ? kInfinity : tree_.bin_volume[tree_.arcs[arc.parent].first_bin];
      double end = root ? tree_.cubics[arc.last_cubic].height : arc.top;
      std::uint32_t p = arc.last_cubic;  // `least` is for what lies above this cubic, which ends at `end`
      for (std::uint32_t c = arc.last_bin + 2; c-- > arc.first_bin;) {
        for (; p > tree_.bins[c]; --p) {
          const Cubic& cubic = tree_.cubics[p];
          least = std::min(least, cubic.volume - fall(cubic, end));
          end = cubic.height;
        }
        const Cubic& cubic = tree_.cubics[p];
        const double own = fall(cubic, end);
        double& volume = tree_.bin_volume[c];
        volume = std::min(least, own > tolerance_ ? cubic.volume - own : volume);
      }
    }
  }

  // The most by which V falls between a cubic's beginning and its end.
  static double fall(const Cubic& cubic, double end) {
    const double b = cubic.half_slope, c3 = 3 * cubic.sixth_bend, width = end - cubic.height;
    double least = std::min(cubic.area, cubic.area_at(end));
    if (b < 0 && -b < c3 * width) least = std::min(least, cubic.area - b * b / c3);
    return least < 0 ? -least * width : 0;
  }

  void check() const {
    if (tree_.roots != input_.solid_volume.size()) {
      throw_invariant(std::to_string(tree_.roots) + " roots for " +
                      std::to_string(input_.solid_volume.size()) + " solids");
    }
    if (tree_.min_volume_change < -tolerance_) {
      throw_invariant("the volume falls by " + std::to_string(-tree_.min_volume_change / input_.volume) +
                      " v0 along an arc");
    }
    for (std::size_t a = 0; a < tree_.arcs.size(); ++a) {
      if (tree_.arcs[a].parent != kNone) continue;
      const double volume = tree_.cubics[tree_.arcs[a].last_cubic].volume;
      const double expected = input_.solid_volume[topology_.arc_solid[a]];
      if (!(std::abs(volume - expected) <= tolerance_)) {
        throw_invariant("the tree of solid " + std::to_string(topology_.arc_solid[a]) + " holds 1 + " +
                        base::to_text(volume / expected - 1) + " of its volume");
      }
    }
  }

  static std::string in_words(const Vec3& d) {
    return "(" + base::to_text(d.x) + ", " + base::to_text(d.y) + ", " + base::to_text(d.z) + ")";
  }

  [[noreturn]] void throw_invariant(const std::string& what) const {
    throw CoreError(CoreError::Code::kInternal,
                    "join tree invariant broken for direction " + in_words(d_) + ": " + what);
  }

  const TreeInput& input_;
  double tolerance_;
  JoinTreeOptions options_;
  Vec3 d_;
  HeightOrder heights_;
  SectionBends vertex_;
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
