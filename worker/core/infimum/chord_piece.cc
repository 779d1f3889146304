// Notation.  x the point, d the plane's normal, u and w its axes; heights are d.(y - x), below means < 0.
// Loops: of the section, see SectionLoops.
//
// Which loops bound the piece.  The piece's boundary consists of lids (parts of the section) and patches (parts
// of the surface below), joined along loops, and of whole shells: cavities below the plane.  So three kinds of
// joins are followed, with union-find over loops and over "comps", the parts of the vertices' tree that lie
// below the plane without a break:
//   - a loop and the comp that its edges rise from.  Comps and loops alone join a patch of a sphere: an edge
//     within the patch that the tree does not use closes a cycle with it, the loops cross the cycle an even
//     number of times without crossing each other, and so each gap of the tree is bridged by a loop.  The
//     edges that cut handles open count as the tree's.
//   - loops of one lid: the loop that a ray in the plane meets next, where solid lies between.
//   - a shell wholly below, and what a ray downwards from it meets.
// Where a single shell without handles is all there is, a loop parts it in two, and the patches are told apart by
// the sides of the loops on which they lie.
#include "core/infimum/chord_piece.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/infimum/section_loops.h"

namespace affskel::core {
namespace {

constexpr std::size_t kMostSides = 64;  // bits of a word
constexpr double kBeside = 1e-9;        // more than places are off by rounding

using PlanePoint = SectionLoops::PlanePoint;
using Cut = SectionLoops::Cut;
using Loop = SectionLoops::Loop;

// An edge of the vertices' trees that the plane cuts.
struct CutEdge {
  PieceInput::Branch branch;  // of its end away from the root
  std::uint32_t child = 0, loop = 0;
  bool child_below = false;
  std::uint32_t outer = kNone;  // the innermost cut edge above it in the tree
};

}  // namespace

class PieceFinder::Work {
 public:
  explicit Work(const PieceInput& input) : in_(input), section_(input), loops_(section_.loops()) {
    solid_shells_.resize(input.shells.size());
    for (std::uint32_t s = 0; s < input.shells.size(); ++s) {
      solid_shells_[input.shells[s].solid].push_back(s);
    }
  }

  ChordPiece find(const Vec3& x, const Vec3& d) {
    x_ = x;
    d_ = d;
    section_.cut(x, d);
    own_loops_.clear();
    if (in_.is_ball && join_alone()) return piece();
    trace_rest();
    const std::uint32_t own = own_loop();
    if (own == kNone) return {};
    join(own);
    return piece();
  }

  bool holds(std::uint32_t vertex) {
    if (own_loops_.empty()) return false;
    if (!by_sides_) return classes_.find(member_of(vertex)) == classes_.find(own_loops_[0]);
    const std::uint64_t sides = sides_of(vertex) & (~std::uint64_t{0} >> (kMostSides - sides_.size()));
    return std::ranges::any_of(own_loops_, [&](std::uint32_t l) { return sides_[l] == sides; });
  }

  // Some of what meets at the vertex is of the piece, some is not: loops that pass it, and what triangles pass through
  // that begin with it.
  Joins joins_at(std::uint32_t vertex) {
    trace_rest();
    joined_.resize(loops_.size(), 0);
    std::uint32_t beside = vertex;  // in the plane, too
    for (const std::uint32_t other : in_.rings[vertex]) {
      if (!touches(other)) continue;
      if (beside != vertex) return Joins::unknown;
      beside = other;
    }
    const auto crossings = in_.crossings.at(vertex);
    // The plane passes both when it passes the one.
    if (beside != vertex && !(crossings.empty() && only_touches(beside, vertex))) return Joins::unknown;
    std::array<bool, 2> passes{};
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      bool& passed = passes[joined_[l]];
      passed = passed || passes_at(loops_[l], vertex) || (beside != vertex && passes_at(loops_[l], beside));
    }
    for (const CrossingPairs::Crossing& crossing : crossings) {
      const Triangle& other = in_.mesh.triangles[crossing.other];
      if (uses(other, vertex) || corner_below(crossing.triangle) != kNone) continue;
      const std::uint32_t corner = corner_below(crossing.other);
      if (corner != kNone) {
        passes[holds(corner) ? 1 : 0] = true;
      } else if (std::ranges::any_of(other, [&](std::uint32_t v) { return touches(v); })) {
        return Joins::unknown;
      }
    }
    return passes[0] && passes[1] ? Joins::yes : Joins::no;
  }

  Hessian hessian() const {
    Hessian sum{};
    for (const std::uint32_t l : own_loops_) section_.add_bend(loops_[l], sum);
    return sum;
  }

 private:
  // Numbers of the classes' members: loops, then cut edges, then shells.
  std::uint32_t cut_member(std::uint32_t cut) const {
    return static_cast<std::uint32_t>(loops_.size()) + cut;
  }
  std::uint32_t shell_member(std::uint32_t shell) const {
    return static_cast<std::uint32_t>(loops_.size() + section_.edges().size()) + shell;
  }
  std::uint32_t shell_of(const Loop& loop) const { return in_.shell_of[loop.low]; }

  void trace_rest() {
    section_.trace_if([](const SectionLoops::Start&) { return true; });
  }

  std::uint32_t own_loop() const {
    return section_.loop_right_of({}, [](std::uint32_t) { return true; });
  }

  // Whether the loop nearest to x bounds the piece by itself, on a surface like a sphere, as nine in ten do.  Most
  // others need not be known for that: but those that may lie within it in the plane, and those that start from the
  // side of the surface that it cuts off.
  bool join_alone() {
    section_.trace_nearest();
    if (own_loop() != 0) return false;
    const auto edges = section_.edges();
    own_first_.resize(edges.size());
    own_count_.resize(edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      own_first_[i] = in_.branches[edges[i].number].first;
      own_count_[i] = in_.branches[edges[i].number].count;
    }
    const Loop own = loops_[0];
    const bool own_side = is_odd(own.low);
    section_.trace_if([&](const SectionLoops::Start& start) {
      if (is_odd(in_.begin_of(start.half_edge)) == own_side) return true;
      const PlanePoint at = section_.place(start);
      return at.a >= own.least.a - kBeside && at.a <= own.most.a + kBeside && at.b >= own.least.b - kBeside &&
             at.b <= own.most.b + kBeside;
    });
    if (!(own.area > 0) || loops_.size() > kMostSides) return false;
    if (loops_.size() > 1 && own_loop() != 0) return false;
    join(0);
    return std::ranges::count(joined_, 1) == 1;
  }

  // Whether the way from a vertex to the root in the tree passes the loop an odd number of times.
  bool is_odd(std::uint32_t vertex) const {
    const std::uint32_t first = in_.branches[vertex].first, *firsts = own_first_.data(),
                        *counts = own_count_.data();
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < own_first_.size(); ++i) count += first - firsts[i] < counts[i];
    return count % 2 != 0;
  }

  void join(std::uint32_t own) {
    solid_ = in_.shells[shell_of(loops_[own])].solid;
    joined_.assign(loops_.size(), 0);
    whole_.clear();
    by_sides_ = in_.is_ball && loops_.size() <= kMostSides;
    if (by_sides_) return join_by_sides(own);
    classes_.reset(loops_.size() + section_.edges().size() + in_.shells.size());
    join_patches();
    join_lids();
    join_handles();
    join_crossings();
    join_whole_shells();
    const std::uint32_t of_own = classes_.find(own);
    for (std::uint32_t l = 0; l < loops_.size(); ++l) joined_[l] = classes_.find(l) == of_own;
    for (const std::uint32_t s : solid_shells_[solid_]) {
      const std::uint32_t root = in_.shells[s].root;
      if (classes_.find(shell_member(s)) == of_own && section_.below(root)) whole_.push_back(root);
    }
  }

  bool touches(std::uint32_t vertex) const {
    return std::abs(dot(d_, in_.mesh.points[vertex] - x_)) <= 4 * kTouchHeight;
  }

  // Whether of those round a vertex the plane touches this one alone, and passes both when it passes it.
  bool only_touches(std::uint32_t vertex, std::uint32_t other) const {
    return in_.crossings.at(vertex).empty() &&
           dot(in_.mesh.points[vertex] - x_, in_.mesh.points[other] - x_) > 0 &&
           std::ranges::none_of(in_.rings[vertex], [&](std::uint32_t v) { return v != other && touches(v); });
  }

  bool passes_at(const Loop& loop, std::uint32_t vertex) const {
    const auto cuts = section_.cuts().subspan(loop.begin, loop.end - loop.begin);
    return std::ranges::any_of(
        cuts, [&](const Cut& cut) { return uses(in_.mesh.triangles[cut.triangle()], vertex); });
  }

  std::uint64_t sides_of(std::uint32_t vertex) const {
    std::uint64_t sides = 0;
    for (const SectionLoops::Edge& edge : section_.edges()) {
      const bool passed = in_.branches[edge.number].holds(in_.branches[vertex]);
      sides ^= passed ? std::uint64_t{1} << edge.loop : 0;
    }
    return sides;
  }

  // A vertex lies on the root's side of a loop where the way to the root in the tree passes it an even number of
  // times.
  void join_by_sides(std::uint32_t own) {
    sides_.clear();
    for (const Loop& loop : loops_) sides_.push_back(sides_of(loop.low));
    classes_.reset(loops_.size());
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      for (std::uint32_t other = 0; other < l; ++other) {
        if (sides_[l] == sides_[other]) classes_.unite(l, other);
      }
    }
    join_lids();
    const std::uint32_t of_own = classes_.find(own), root = in_.shells[0].root;
    bool root_side = false;
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      joined_[l] = classes_.find(l) == of_own;
      root_side = root_side || (joined_[l] != 0 && sides_[l] == 0);
    }
    if (root_side) whole_.push_back(root);
  }

  bool is_handle(const SectionLoops::Edge& edge) const { return edge.number >= in_.mesh.points.size(); }

  bool of_solid(const Loop& loop) const { return in_.shells[shell_of(loop)].solid == solid_; }

  void join_patches() {
    cuts_.clear();
    for (const SectionLoops::Edge& edge : section_.edges()) {
      if (!is_handle(edge))
        cuts_.push_back({in_.branches[edge.number], edge.number, edge.loop, edge.low == edge.number, kNone});
    }
    std::sort(cuts_.begin(), cuts_.end(),
              [](const CutEdge& i, const CutEdge& j) { return i.branch.first < j.branch.first; });
    std::uint32_t open = kNone;  // the innermost cut edge that the present one may lie below
    for (std::uint32_t i = 0; i < cuts_.size(); ++i) {
      CutEdge& cut = cuts_[i];
      while (open != kNone && !cuts_[open].branch.holds(cut.branch)) open = cuts_[open].outer;
      cut.outer = open;
      classes_.unite(cut.loop, cut.child_below ? cut_member(i)
                               : open != kNone ? cut_member(open)
                                               : shell_member(in_.shell_of[cut.child]));
      open = i;
    }
  }

  // The member that a vertex below the plane belongs to.
  std::uint32_t member_of(std::uint32_t vertex) const {
    const PieceInput::Branch& branch = in_.branches[vertex];
    const auto after =
        std::upper_bound(cuts_.begin(), cuts_.end(), branch.first,
                         [](std::uint32_t first, const CutEdge& cut) { return first < cut.branch.first; });
    std::uint32_t at = after == cuts_.begin() ? kNone : static_cast<std::uint32_t>(after - cuts_.begin() - 1);
    while (at != kNone && !cuts_[at].branch.holds(branch)) at = cuts_[at].outer;
    return at != kNone ? cut_member(at) : shell_member(in_.shell_of[vertex]);
  }

  void join_lids() {
    if (loops_.size() < 2) return;
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      if (!of_solid(loops_[l])) continue;
      const std::uint32_t next =
          section_.loop_right_of(section_.rightmost(loops_[l]),
                                 [&](std::uint32_t other) { return other != l && of_solid(loops_[other]); });
      if (next != kNone) classes_.unite(l, next);
    }
  }

  void join_handles() {
    for (const SectionLoops::Edge& edge : section_.edges()) {
      if (!is_handle(edge)) continue;
      classes_.unite(edge.loop, member_of(edge.low));
    }
    for (const std::uint32_t s : solid_shells_[solid_]) {
      for (const Segment& edge : in_.shells[s].handles) {
        if (section_.below(edge[0]) && section_.below(edge[1]))
          classes_.unite(member_of(edge[0]), member_of(edge[1]));
      }
    }
  }

  std::uint32_t corner_below(std::uint32_t triangle) const {
    for (const std::uint32_t v : in_.mesh.triangles[triangle]) {
      if (section_.below(v)) return v;
    }
    return kNone;
  }

  // As in the join tree: what passes through each other is joined as soon as both have begun.
  void join_crossings() {
    const auto below = [&](std::uint32_t vertex) { return section_.below(vertex); };
    in_.crossings.each_new(x_, d_, lists_, below, [&](const CrossingPair& pair) {
      const std::uint32_t a = corner_below(pair.first), b = a == kNone ? kNone : corner_below(pair.second);
      if (b != kNone) classes_.unite(member_of(a), member_of(b));
    });
  }

  void join_whole_shells() {
    const std::vector<std::uint32_t>& shells = solid_shells_[solid_];
    if (shells.size() < 2) return;
    cut_shell_.assign(in_.shells.size(), 0);
    for (const Loop& loop : loops_) cut_shell_[shell_of(loop)] = 1;
    for (const std::uint32_t s : shells) {
      const std::uint32_t root = in_.shells[s].root;
      if (cut_shell_[s] != 0 || !section_.below(root)) continue;
      const std::uint32_t exit = in_.rays->first_exit_below(root, d_, [&](std::uint32_t t) {
        const std::uint32_t other = in_.shell_of[in_.mesh.triangles[t][0]];
        return other != s && in_.shells[other].solid == solid_;
      });
      if (exit == kNone) continue;
      const std::uint32_t corner = corner_below(exit);
      if (corner != kNone) classes_.unite(shell_member(s), member_of(corner));
    }
  }

  ChordPiece piece() {
    ChordPiece piece;
    piece.found = true;
    SurfaceSums whole;  // of the triangles with two corners below, or three
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      if (joined_[l] == 0) continue;
      const Loop& loop = loops_[l];
      own_loops_.push_back(l);
      piece.volume += loop.volume;
      piece.area += loop.area;
      for (std::size_t k = 0; k < 2; ++k) piece.gradient[k] -= loop.moment[k];
      for (const std::uint32_t h :
           section_.alone_first().subspan(loop.alone_begin, loop.alone_end - loop.alone_begin)) {
        const SurfaceSums& sums = in_.faces[h / 3].sums;
        if (h % 3 == 0) {
          whole -= sums;
        } else {
          whole += sums;
        }
      }
    }
    for (const SectionLoops::Edge& edge : section_.edges()) {
      if (joined_[edge.loop] == 0 || is_handle(edge)) continue;
      if (edge.low == edge.number) {
        whole += in_.below[edge.number];
      } else {
        whole -= in_.below[edge.number];
      }
    }
    for (const std::uint32_t root : whole_) whole += in_.below[root];
    piece.volume += whole.volume_from(x_);
    piece.u = section_.u();
    piece.w = section_.w();
    return piece;
  }

  const PieceInput& in_;
  SectionLoops section_;
  const std::vector<Loop>& loops_;
  std::vector<std::vector<std::uint32_t>> solid_shells_;  // per solid
  Vec3 x_, d_;
  std::uint32_t solid_ = 0;
  FourTree::Lists lists_;
  std::vector<CutEdge> cuts_;
  DisjointSets classes_;
  bool by_sides_ = false;                             // how the loops were joined
  std::vector<std::uint32_t> own_first_, own_count_;  // branches of the edges that join_alone()'s loop passes
  std::vector<std::uint64_t> sides_;      // per loop: bits of the loops with the root on their other side
  std::vector<std::uint8_t> joined_;      // per loop: whether it bounds the piece
  std::vector<std::uint32_t> whole_;      // roots that lie in it
  std::vector<std::uint32_t> own_loops_;  // of the piece
  std::vector<std::uint8_t> cut_shell_;   // per shell
};

PieceFinder::PieceFinder(const PieceInput& input) : work_(std::make_unique<Work>(input)) {}
PieceFinder::~PieceFinder() = default;

ChordPiece PieceFinder::find(const Vec3& x, const Vec3& d) {
  return work_->find(x, d);
}

Hessian PieceFinder::hessian() const {
  return work_->hessian();
}

bool PieceFinder::holds(std::uint32_t vertex) {
  return work_->holds(vertex);
}

PieceFinder::Joins PieceFinder::joins_at(std::uint32_t vertex) {
  return work_->joins_at(vertex);
}

}  // namespace affskel::core
