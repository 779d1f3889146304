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
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/infimum/section_loops.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kNone = PieceInput::kNone;
constexpr double kThird = 1.0 / 3;
constexpr std::size_t kMostSides = 64;  // bits of a word
constexpr double kSteepest = 1e9;       // of cot(inclination): level triangles have no finite one

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
    const std::uint32_t own = section_.loop_right_of({}, [](std::uint32_t) { return true; });
    if (own == kNone) return {};
    join(own);
    return piece();
  }

  bool holds(std::uint32_t vertex) {
    if (own_loops_.empty()) return false;
    if (!by_sides_) return classes_.find(member_of(vertex)) == classes_.find(own_loops_[0]);
    const std::uint64_t sides = sides_of(vertex);
    return std::ranges::any_of(own_loops_, [&](std::uint32_t l) { return sides_[l] == sides; });
  }

  // Some loops that pass the vertex bound the piece, others do not.
  Joins joins_at(std::uint32_t vertex) const {
    if (!in_.crosses.empty() && in_.crosses[vertex] != 0) return Joins::unknown;
    std::uint32_t beside = vertex;  // in the plane, too
    for (const std::uint32_t other : in_.rings[vertex]) {
      if (!touches(other)) continue;
      if (beside != vertex) return Joins::unknown;
      beside = other;
    }
    // The plane passes both when it passes the one.
    if (beside != vertex && !only_touches(beside, vertex)) return Joins::unknown;
    std::array<bool, 2> passes{};
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      bool& passed = passes[joined_[l]];
      passed = passed || passes_at(loops_[l], vertex) || (beside != vertex && passes_at(loops_[l], beside));
    }
    return passes[0] && passes[1] ? Joins::yes : Joins::no;
  }

  Hessian hessian() const {
    Hessian sum{};
    for (const std::uint32_t l : own_loops_) add_bend(loops_[l], sum);
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
    return (in_.crosses.empty() || in_.crosses[vertex] == 0) &&
           dot(in_.mesh.points[vertex] - x_, in_.mesh.points[other] - x_) > 0 &&
           std::ranges::none_of(in_.rings[vertex], [&](std::uint32_t v) { return v != other && touches(v); });
  }

  bool passes_at(const Loop& loop, std::uint32_t vertex) const {
    const auto cuts = std::span(section_.cuts()).subspan(loop.begin, loop.end - loop.begin);
    return std::ranges::any_of(cuts, [&](const Cut& cut) {
      const Triangle& corners = in_.mesh.triangles[cut.triangle()];
      return corners[0] == vertex || corners[1] == vertex || corners[2] == vertex;
    });
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
        cuts_.push_back({in_.branches[edge.number], edge.number, edge.loop, edge.begin_below, kNone});
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
      const std::uint32_t next = section_.loop_right_of(
          loops_[l].rightmost, [&](std::uint32_t other) { return other != l && of_solid(loops_[other]); });
      if (next != kNone) classes_.unite(l, next);
    }
  }

  void join_handles() {
    for (const SectionLoops::Edge& edge : section_.edges()) {
      if (!is_handle(edge)) continue;
      const PieceInput::Edge& of_mesh = in_.edges[edge.number];
      classes_.unite(edge.loop, member_of(edge.begin_below ? of_mesh.begin : of_mesh.end));
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
    for (const auto& [i, j] : in_.crossings) {
      const std::uint32_t a = corner_below(i), b = a == kNone ? kNone : corner_below(j);
      if (b != kNone) classes_.unite(member_of(a), member_of(b));
    }
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
      if (exit == RayShooter::kNone) continue;
      const std::uint32_t corner = corner_below(exit);
      if (corner != kNone) classes_.unite(shell_member(s), member_of(corner));
    }
  }

  ChordPiece piece() {
    Sums sums;
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      if (joined_[l] == 0) continue;
      own_loops_.push_back(l);
      add_up(loops_[l], sums);
    }
    for (const SectionLoops::Edge& edge : section_.edges()) {
      if (joined_[edge.loop] == 0 || is_handle(edge)) continue;
      if (edge.begin_below) {
        sums.whole += in_.below[edge.number];
      } else {
        sums.whole -= in_.below[edge.number];
      }
    }
    for (const std::uint32_t root : whole_) sums.whole += in_.below[root];
    ChordPiece piece;
    piece.found = true;
    piece.volume = sums.cut + sums.whole.volume_from(x_);
    piece.area = sums.area;
    piece.u = section_.u();
    piece.w = section_.w();
    piece.gradient = {-sums.moment[0], -sums.moment[1]};
    return piece;
  }

  struct Sums {
    double cut = 0;  // volume below the cut triangles, with the origin x
    double area = 0;
    std::array<double, 2> moment{};
    SurfaceSums whole;  // of the triangles that are not cut
  };

  void add_up(const Loop& loop, Sums& sums) const {
    sums.area += loop.area;
    for (std::size_t k = 0; k < 2; ++k) sums.moment[k] += loop.moment[k];
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) add_triangle(section_.cuts()[i], sums);
  }

  void add_triangle(const Cut& cut, Sums& sums) const {
    const PieceInput::Face& face = in_.faces[cut.triangle()];
    const double corner = cut.alone * cut.alone / ((cut.alone + cut.others[0]) * (cut.alone + cut.others[1]));
    const double share = cut.corner_below ? corner : 1 - corner;
    sums.cut += kThird * share * dot(face.area, in_.mesh.points[cut.corner] - x_);
    if (cut.first_below()) sums.whole -= face.sums;
  }

  void add_bend(const Loop& loop, Hessian& sum) const {
    PlanePoint from = section_.cuts()[loop.end - 1].leaves;
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
      const Cut& cut = section_.cuts()[i];
      const PlanePoint& to = cut.leaves;
      const double weight = kThird * spread(cut.triangle(), {to.a - from.a, to.b - from.b});
      sum[0] += weight * (from.a * from.a + from.a * to.a + to.a * to.a);
      sum[1] += weight * (from.a * from.b + 0.5 * (from.a * to.b + to.a * from.b) + to.a * to.b);
      sum[2] += weight * (from.b * from.b + from.b * to.b + to.b * to.b);
      from = to;
    }
  }

  // How far a stretch of the rim moves outwards in the plane when that rises by one, times its length.
  double spread(std::uint32_t triangle, const PlanePoint& stretch) const {
    const Vec3& n = in_.faces[triangle].area;
    const double up = -dot(n, d_), a = dot(n, section_.u()), b = dot(n, section_.w());
    const double across = a * a + b * b;
    if (across * (kSteepest * kSteepest) > up * up) {
      // The stretch is a multiple of (-b, a).
      return up * (a * stretch.b - b * stretch.a) / across;
    }
    return (up > 0 ? kSteepest : -kSteepest) * std::sqrt(stretch.a * stretch.a + stretch.b * stretch.b);
  }

  const PieceInput& in_;
  SectionLoops section_;
  const std::vector<Loop>& loops_;
  std::vector<std::vector<std::uint32_t>> solid_shells_;  // per solid
  Vec3 x_, d_;
  std::uint32_t solid_ = 0;
  std::vector<CutEdge> cuts_;
  DisjointSets classes_;
  bool by_sides_ = false;                 // how the loops were joined
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

PieceFinder::Joins PieceFinder::joins_at(std::uint32_t vertex) const {
  return work_->joins_at(vertex);
}

}  // namespace affskel::core
