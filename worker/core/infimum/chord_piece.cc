// Notation.  x the point, d the plane's normal, u and w its axes; heights are d.(y - x), below means < 0.
// The rim: the triangles that the plane cuts.  They form loops, each a closed polygon with the section on its
// left, seen from above.  The edge by which a loop leaves a triangle rises from below to above.
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
#include "core/infimum/chord_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace affskel::core {
namespace {

constexpr std::uint32_t kNone = PieceInput::kNone;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kThird = 1.0 / 3;
constexpr double kSteepest = 1e9;  // of cot(inclination): level triangles have no finite one

struct Flat {
  double a = 0, b = 0;  // y - x = a u + b w
};

// A triangle that the plane cuts.
struct RimTriangle {
  std::uint32_t triangle = 0;
  std::array<double, 3> height{};
};

// A place of a loop: where it leaves a triangle.
struct RimPlace {
  Flat at;
  std::uint32_t rim = 0;
};

struct Loop {
  std::uint32_t begin = 0, end = 0;  // of places
  std::uint32_t shell = 0;
  double high_a = -kInfinity, low_b = kInfinity, high_b = -kInfinity;
  Flat rightmost{-kInfinity, 0};  // but for vertices that the plane touches, where loops may meet
};

// A tree edge that the plane cuts, by its lower end in the tree.
struct CutEdge {
  std::uint32_t child = 0, loop = 0;
  bool child_below = false;
  std::uint32_t outer = kNone;  // the innermost cut edge above it in the tree
};

struct LoopSums {
  double volume = 0;  // of the cut triangles' parts below, with the origin x
  double area = 0;
  std::array<double, 2> moment{};
  std::array<double, 3> bend{};
  SurfaceSums whole;  // of the triangles that are not cut, but for the roots' totals

  void add(const LoopSums& other) {
    volume += other.volume;
    area += other.area;
    for (std::size_t i = 0; i < 2; ++i) moment[i] += other.moment[i];
    for (std::size_t i = 0; i < 3; ++i) bend[i] += other.bend[i];
    whole += other.whole;
  }
};

// Not std::hypot, which may differ from machine to machine.
double length(const Flat& from, const Flat& to) {
  const double a = to.a - from.a, b = to.b - from.b;
  return std::sqrt(a * a + b * b);
}

// Two unit vectors that form a right-handed basis with d (Duff et al. 2017).
void make_basis(const Vec3& d, Vec3& u, Vec3& w) {
  const double sign = d.z >= 0 ? 1 : -1;
  const double s = -1 / (sign + d.z), m = d.x * d.y * s;
  u = {1 + sign * d.x * d.x * s, sign * m, -sign * d.x};
  w = {m, sign + d.y * d.y * s, -d.y};
}

}  // namespace

class PieceFinder::Work {
 public:
  explicit Work(const PieceInput& input) : in_(input), mark_(input.mesh.triangles.size(), 0) {
    solid_shells_.resize(input.shells.size());
    for (std::uint32_t s = 0; s < input.shells.size(); ++s) {
      solid_shells_[input.shells[s].solid].push_back(s);
    }
  }

  ChordPiece find(const Vec3& x, const Vec3& d) {
    x_ = x;
    d_ = d;
    make_basis(d, u_, w_);
    collect_rim();
    trace_loops();
    const std::uint32_t own = loop_round_x();
    if (own == kNone) return {};
    join(own);
    return piece(own);
  }

 private:
  // 0 for what lies above within rounding.
  double height(std::uint32_t vertex) const {
    const double h = dot(d_, in_.mesh.points[vertex] - x_);
    return h < -kTouchHeight ? h : std::max(h, 0.0);
  }
  bool below(std::uint32_t vertex) const { return height(vertex) < 0; }

  void collect_rim() {
    rim_.clear();
    const Vec3 size{std::abs(d_.x), std::abs(d_.y), std::abs(d_.z)};
    for (std::uint32_t n = 0; n < in_.nodes.size();) {
      const PieceInput::Node& node = in_.nodes[n];
      if (std::abs(dot(d_, node.centre - x_)) > dot(size, node.half) + 2 * kTouchHeight) {
        n = node.skip;
        continue;
      }
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
        const Triangle& c = in_.mesh.triangles[t];
        const std::array<double, 3> h = {height(c[0]), height(c[1]), height(c[2])};
        const int count = (h[0] < 0) + (h[1] < 0) + (h[2] < 0);
        if (count == 1 || count == 2) rim_.push_back({t, h});
      }
      ++n;
    }
    if (first_mark_ > kNone - rim_.size() - 1) {
      std::fill(mark_.begin(), mark_.end(), 0);
      first_mark_ = 1;
    }
    for (std::uint32_t i = 0; i < rim_.size(); ++i) mark_[rim_[i].triangle] = first_mark_ + i;
  }

  void trace_loops() {
    loops_.clear();
    places_.clear();
    cuts_.clear();
    risers_.clear();
    sums_.clear();
    done_.assign(rim_.size(), 0);
    for (std::uint32_t i = 0; i < rim_.size(); ++i) {
      if (done_[i] == 0) trace_loop(i);
    }
    first_mark_ += static_cast<std::uint32_t>(rim_.size());
  }

  void trace_loop(std::uint32_t start) {
    const auto index = static_cast<std::uint32_t>(loops_.size());
    Loop loop;
    loop.begin = static_cast<std::uint32_t>(places_.size());
    LoopSums sums;
    for (std::uint32_t i = start; done_[i] == 0;) {
      done_[i] = 1;
      const RimTriangle& rim = rim_[i];
      const std::size_t k = rising_edge(rim);
      const Triangle& c = in_.mesh.triangles[rim.triangle];
      const std::uint32_t low = c[k], high = c[(k + 1) % 3];
      places_.push_back({cut(low, high, rim.height[k], rim.height[(k + 1) % 3]), i});
      const Flat& at = places_.back().at;
      loop.high_a = std::max(loop.high_a, at.a);
      loop.low_b = std::min(loop.low_b, at.b);
      loop.high_b = std::max(loop.high_b, at.b);
      if (rim.height[(k + 1) % 3] > kTouchHeight && at.a > loop.rightmost.a) loop.rightmost = at;
      if (in_.parent[std::max(low, high)] == std::min(low, high)) cut_edge(low, high, index, sums.whole);
      if (!in_.at_handle.empty() && in_.at_handle[3 * rim.triangle + k] != 0) risers_.emplace_back(low, index);
      loop.shell = in_.shell_of[low];
      i = mark_[in_.mates[3 * rim.triangle + k] / 3] - first_mark_;
    }
    loop.end = static_cast<std::uint32_t>(places_.size());
    add_up(loop, sums);
    loops_.push_back(loop);
    sums_.push_back(sums);
  }

  static std::size_t rising_edge(const RimTriangle& rim) {
    const bool b0 = rim.height[0] < 0, b1 = rim.height[1] < 0, b2 = rim.height[2] < 0;
    return b0 && !b1 ? 0 : b1 && !b2 ? 1 : 2;
  }

  Flat cut(std::uint32_t low, std::uint32_t high, double low_height, double high_height) const {
    const Vec3& p = in_.mesh.points[low];
    const Vec3 y = (p - x_) + (low_height / (low_height - high_height)) * (in_.mesh.points[high] - p);
    return {dot(u_, y), dot(w_, y)};
  }

  void cut_edge(std::uint32_t low, std::uint32_t high, std::uint32_t loop, SurfaceSums& whole) {
    const std::uint32_t child = std::max(low, high);
    cuts_.push_back({child, loop, child == low});
    if (child == low) {
      whole += in_.below(child);
    } else {
      whole -= in_.below(child);
    }
  }

  void add_up(const Loop& loop, LoopSums& sums) const {
    Flat from = places_[loop.end - 1].at;
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
      const Flat to = places_[i].at;
      const RimTriangle& rim = rim_[places_[i].rim];
      add_triangle(rim, sums);
      const double turn = from.a * to.b - to.a * from.b;
      sums.area += 0.5 * turn;
      sums.moment[0] += turn * (from.a + to.a) / 6;
      sums.moment[1] += turn * (from.b + to.b) / 6;
      const double weight = slope(rim.triangle) * length(from, to) * kThird;
      sums.bend[0] += weight * (from.a * from.a + from.a * to.a + to.a * to.a);
      sums.bend[1] += weight * (from.a * from.b + 0.5 * (from.a * to.b + to.a * from.b) + to.a * to.b);
      sums.bend[2] += weight * (from.b * from.b + from.b * to.b + to.b * to.b);
      from = to;
    }
  }

  // How far the rim moves outwards in the plane when that rises by one.
  double slope(std::uint32_t triangle) const {
    const Vec3& n = in_.area_vector[triangle];
    const double up = -dot(n, d_), a = dot(n, u_), b = dot(n, w_), across = std::sqrt(a * a + b * b);
    return across * kSteepest > std::abs(up) ? up / across : up > 0 ? kSteepest : -kSteepest;
  }

  void add_triangle(const RimTriangle& rim, LoopSums& sums) const {
    const auto& h = rim.height;
    const Triangle& c = in_.mesh.triangles[rim.triangle];
    // The corner that is alone on its side.
    const bool b0 = h[0] < 0, b1 = h[1] < 0, b2 = h[2] < 0;
    const std::size_t k = b1 == b2 ? 0 : b0 == b2 ? 1 : 2;
    const double corner = h[k] / (h[k] - h[(k + 1) % 3]) * (h[k] / (h[k] - h[(k + 2) % 3]));
    const double share = h[k] < 0 ? corner : 1 - corner;
    sums.volume += kThird * share * dot(in_.area_vector[rim.triangle], in_.mesh.points[c[k]] - x_);
    if (b0) sums.whole -= in_.own[rim.triangle];
  }

  // Where the loop passes the ray from (a, b) to the right: calls visit(a there, whether b grows).
  template <class Visit>
  void crossings_right(const Loop& loop, double a, double b, Visit visit) const {
    if (b < loop.low_b || b > loop.high_b || loop.high_a < a) return;
    Flat from = places_[loop.end - 1].at;
    for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
      const Flat to = places_[i].at;
      if ((from.b > b) != (to.b > b)) {
        const double at = from.a + (b - from.b) / (to.b - from.b) * (to.a - from.a);
        if (at > a) visit(at, to.b > from.b);
      }
      from = to;
    }
  }

  // The loop through which a ray to the right leaves the section first, where it starts inside.  Only ways out
  // count: where the plane touches an edge, two loops run along it, one of them the way in.
  template <class OfLid>
  std::uint32_t loop_right_of(double a, double b, OfLid of_lid) const {
    std::uint32_t nearest = kNone;
    double least = kInfinity;
    int winding = 0;
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      if (!of_lid(l)) continue;
      crossings_right(loops_[l], a, b, [&](double at, bool out) {
        winding += out ? 1 : -1;
        if (!out || at >= least) return;
        least = at;
        nearest = l;
      });
    }
    return winding > 0 ? nearest : kNone;
  }

  std::uint32_t loop_round_x() const {
    return loop_right_of(0, 0, [](std::uint32_t) { return true; });
  }

  std::uint32_t find_class(std::uint32_t a) {
    while (class_[a] != a) a = class_[a] = class_[class_[a]];
    return a;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find_class(a);
    b = find_class(b);
    class_[std::max(a, b)] = std::min(a, b);
  }

  // Numbers of the classes' members: loops, then cut edges, then shells.
  std::uint32_t cut_member(std::uint32_t cut) const { return static_cast<std::uint32_t>(loops_.size()) + cut; }
  std::uint32_t shell_member(std::uint32_t shell) const {
    return static_cast<std::uint32_t>(loops_.size() + cuts_.size()) + shell;
  }

  void join(std::uint32_t own) {
    solid_ = in_.shells[loops_[own].shell].solid;
    class_.resize(loops_.size() + cuts_.size() + in_.shells.size());
    std::iota(class_.begin(), class_.end(), 0U);
    if (loops_.size() > 1 || solid_shells_[solid_].size() > 1 || !in_.crossings.empty()) {
      join_patches();
      join_lids();
      join_handles();
      join_crossings();
      join_whole_shells();
    } else {
      unite(own, shell_member(loops_[own].shell));
    }
  }

  bool of_solid(const Loop& loop) const { return in_.shells[loop.shell].solid == solid_; }

  void join_patches() {
    std::sort(cuts_.begin(), cuts_.end(),
              [](const CutEdge& i, const CutEdge& j) { return i.child < j.child; });
    std::uint32_t open = kNone;  // the innermost cut edge that the present one may lie below
    for (std::uint32_t i = 0; i < cuts_.size(); ++i) {
      CutEdge& cut = cuts_[i];
      while (open != kNone && in_.end[cuts_[open].child] <= cut.child) open = cuts_[open].outer;
      cut.outer = open;
      unite(cut.loop, cut.child_below ? cut_member(i)
                      : open != kNone ? cut_member(open)
                                      : shell_member(in_.shell_of[cut.child]));
      open = i;
    }
  }

  // The member that a vertex below the plane belongs to.
  std::uint32_t member_of(std::uint32_t vertex) const {
    const auto after = std::upper_bound(cuts_.begin(), cuts_.end(), vertex,
                                        [](std::uint32_t v, const CutEdge& cut) { return v < cut.child; });
    std::uint32_t at = after == cuts_.begin() ? kNone : static_cast<std::uint32_t>(after - cuts_.begin() - 1);
    while (at != kNone && in_.end[cuts_[at].child] <= vertex) at = cuts_[at].outer;
    return at != kNone ? cut_member(at) : shell_member(in_.shell_of[vertex]);
  }

  void join_lids() {
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      if (!of_solid(loops_[l])) continue;
      const Flat& start = loops_[l].rightmost;
      const std::uint32_t next = loop_right_of(
          start.a, start.b, [&](std::uint32_t other) { return other != l && of_solid(loops_[other]); });
      if (next != kNone) unite(l, next);
    }
  }

  void join_handles() {
    for (const auto& [low, loop] : risers_) unite(loop, member_of(low));
    for (const std::uint32_t s : solid_shells_[solid_]) {
      for (const Segment& edge : in_.shells[s].handles) {
        if (below(edge[0]) && below(edge[1])) unite(member_of(edge[0]), member_of(edge[1]));
      }
    }
  }

  std::uint32_t corner_below(std::uint32_t triangle) const {
    for (const std::uint32_t v : in_.mesh.triangles[triangle]) {
      if (below(v)) return v;
    }
    return kNone;
  }

  // As in the join tree: what passes through each other is joined as soon as both have begun.
  void join_crossings() {
    for (const auto& [i, j] : in_.crossings) {
      const std::uint32_t a = corner_below(i), b = a == kNone ? kNone : corner_below(j);
      if (b != kNone) unite(member_of(a), member_of(b));
    }
  }

  void join_whole_shells() {
    const std::vector<std::uint32_t>& shells = solid_shells_[solid_];
    if (shells.size() < 2) return;
    cut_shell_.assign(in_.shells.size(), 0);
    for (const Loop& loop : loops_) cut_shell_[loop.shell] = 1;
    for (const std::uint32_t s : shells) {
      const std::uint32_t root = in_.shells[s].root;
      if (cut_shell_[s] != 0 || !below(root)) continue;
      const std::uint32_t exit = in_.rays->first_exit_below(root, d_, [&](std::uint32_t t) {
        const std::uint32_t other = in_.shell_of[in_.mesh.triangles[t][0]];
        return other != s && in_.shells[other].solid == solid_;
      });
      if (exit == RayShooter::kNone) continue;
      const std::uint32_t corner = corner_below(exit);
      if (corner != kNone) unite(shell_member(s), member_of(corner));
    }
  }

  ChordPiece piece(std::uint32_t own) {
    const std::uint32_t joined = find_class(own);
    LoopSums sums;
    for (std::uint32_t l = 0; l < loops_.size(); ++l) {
      if (find_class(l) == joined) sums.add(sums_[l]);
    }
    for (const std::uint32_t s : solid_shells_[solid_]) {
      const std::uint32_t root = in_.shells[s].root;
      if (find_class(shell_member(s)) == joined && below(root)) sums.whole += in_.below(root);
    }
    ChordPiece piece;
    piece.found = true;
    piece.volume = sums.volume + sums.whole.volume_from(x_);
    piece.area = sums.area;
    piece.u = u_;
    piece.w = w_;
    piece.gradient = {-sums.moment[0], -sums.moment[1]};
    piece.hessian = sums.bend;
    return piece;
  }

  const PieceInput& in_;
  std::vector<std::vector<std::uint32_t>> solid_shells_;  // per solid
  Vec3 x_, d_, u_, w_;
  std::uint32_t solid_ = 0;
  std::vector<RimTriangle> rim_;
  std::vector<std::uint32_t> mark_;  // per triangle: first_mark_ plus its place in the rim
  std::uint32_t first_mark_ = 1;
  std::vector<std::uint8_t> done_;       // per triangle of the rim
  std::vector<RimPlace> places_;         // loop by loop
  std::vector<Loop> loops_;
  std::vector<LoopSums> sums_;           // per loop
  std::vector<CutEdge> cuts_;
  // Edges of handles that the plane cuts: the vertex below and the loop.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> risers_;
  std::vector<std::uint32_t> class_;     // union-find
  std::vector<std::uint8_t> cut_shell_;  // per shell
};

PieceFinder::PieceFinder(const PieceInput& input) : work_(std::make_unique<Work>(input)) {}
PieceFinder::~PieceFinder() = default;

ChordPiece PieceFinder::find(const Vec3& x, const Vec3& d) {
  return work_->find(x, d);
}

}  // namespace affskel::core
