#include "core/infimum/section_loops.h"

#include <algorithm>

#include "core/base/basis.h"

namespace affskel::core {

namespace {

constexpr double kThird = 1.0 / 3;
constexpr double kSteepest = 1e9;  // of cot(inclination): level triangles have no finite one

}  // namespace

SectionLoops::SectionLoops(const PieceInput& input)
    : in_(input),
      passed_(input.edges.size(), 0),
      starts_(input.edges.size()),
      cuts_(input.mesh.triangles.size()),
      alone_first_(input.mesh.triangles.size()),
      edges_(input.edges.size()) {}

// Every loop passes one of the input's edges: what they leave of a shell is a disc without a vertex inside it,
// and a loop has vertices on both sides.
void SectionLoops::cut(const Vec3& x, const Vec3& d) {
  x_ = x;
  d_ = d;
  make_basis(d, u_, w_);
  axes_ = {Two{u_.x, w_.x}, Two{u_.y, w_.y}, Two{u_.z, w_.z}};
  loops_.clear();
  starts_.count = cuts_.count = alone_first_.count = edges_.count = 0;
  if (++number_ == 0) {
    std::fill(passed_.begin(), passed_.end(), 0);
    number_ = 1;
  }
  const PlaneHeights plane(x, d);
  const auto meets = [&](const FourBoxes& boxes) { return plane.passes(boxes); };
  const auto meets_edge = [&](const FourBoxes& boxes) { return plane.passes_segments(boxes); };
  Start* start = starts_.end();
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t n : in_.edge_tree.select(meets, meets_edge, lists_)) {
    const PieceInput::Edge& edge = in_.edges[n];
    const Vec3 y = in_.mesh.points[edge.begin] - x;
    const bool begin_below = dot(d, y) < -kTouchHeight;
    if (begin_below == below(edge.end)) continue;
    *start = {n, begin_below ? edge.there : edge.back};
    if (const double square = dot(y, y); square < least) {
      least = square;
      nearest_ = *start;
    }
    ++start;
  }
  starts_.end_at(start);
}

SectionLoops::PlanePoint SectionLoops::rightmost(const Loop& loop) const {
  PlanePoint most{-std::numeric_limits<double>::infinity(), 0};
  for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
    const Cut& cut = cuts_.items[i];
    if (cut.leaves.a > most.a && height(in_.end_of(cut.edge)) > kTouchHeight) most = cut.leaves;
  }
  return most;
}

void SectionLoops::add_bend(const Loop& loop, std::array<double, 3>& sum) const {
  PlanePoint from = cuts_.items[loop.end - 1].leaves;
  for (std::uint32_t i = loop.begin; i < loop.end; ++i) {
    const Cut& cut = cuts_.items[i];
    const PlanePoint& to = cut.leaves;
    const double weight = kThird * spread(cut.triangle(), {to.a - from.a, to.b - from.b});
    sum[0] += weight * (from.a * from.a + from.a * to.a + to.a * to.a);
    sum[1] += weight * (from.a * from.b + 0.5 * (from.a * to.b + to.a * from.b) + to.a * to.b);
    sum[2] += weight * (from.b * from.b + from.b * to.b + to.b * to.b);
    from = to;
  }
}

// How far a stretch of the rim moves outwards in the plane when that rises by one, times its length.
double SectionLoops::spread(std::uint32_t triangle, const PlanePoint& stretch) const {
  const Vec3& n = in_.faces[triangle].area;
  const double up = -dot(n, d_), a = dot(n, u_), b = dot(n, w_);
  const double across = a * a + b * b;
  if (across * (kSteepest * kSteepest) > up * up) {
    // The stretch is a multiple of (-b, a).
    return up * (a * stretch.b - b * stretch.a) / across;
  }
  return (up > 0 ? kSteepest : -kSteepest) * std::sqrt(stretch.a * stretch.a + stretch.b * stretch.b);
}

// From the half-edge that rises, triangle by triangle, until it comes back.
void SectionLoops::trace(std::uint32_t start) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  // Copies, which what is written cannot change.
  const Vec3 x = x_, d = d_;
  const Axes axes = axes_;
  Cut* cut = cuts_.end();
  std::uint32_t* alone_first = alone_first_.end();
  Edge *const first_edge = edges_.end(), *edge = first_edge;
  Corner low = corner(in_.begin_of(start)), high = corner(in_.end_of(start));
  high.height = std::max(high.height, 0.0);  // as of all corners above
  Loop loop;
  loop.begin = cuts_.count;
  loop.alone_begin = alone_first_.count;
  loop.low = low.vertex;
  Two last = passed(low, high), least{kFar, kFar}, most = -least, moment{};  // moment six times
  double area = 0, volume = 0;                                               // twice; six times
  std::uint32_t h = start;
  do {
    const PieceInput::Passage& passage = in_.passages[h];
    edge->number = passage.edge;
    edge->low = low.vertex;
    edge += passage.edge != kNone;
    const Corner apex = corner(passage.apex, x, d, axes);
    double alone = 0;  // height of the corner that is alone
    // A branch, so that processors go on with a guess: to wait for the height takes longer.
    if (apex.height < -kTouchHeight) {
      alone = high.height;
      low = apex;
      h = *alone_first = passage.when_below;
      alone_first += h % 3 == 2;
    } else {
      alone = low.height;
      high = apex;
      high.height = std::max(apex.height, 0.0);
      h = *alone_first = passage.when_above;
      alone_first += h % 3 == 0;
    }
    const Two at = passed(low, high);
    *cut++ = {{at[0], at[1]}, h};
    const double turn = last[0] * at[1] - at[0] * last[1];
    area += turn;
    volume -= alone * turn;
    moment += turn * (last + at);
    last = at;
    least = at < least ? at : least;
    most = at > most ? at : most;
  } while (h != start);
  for (Edge* e = first_edge; e != edge; ++e) {
    passed_[e->number] = number_;
    e->loop = static_cast<std::uint32_t>(loops_.size());
  }
  cuts_.end_at(cut);
  alone_first_.end_at(alone_first);
  edges_.end_at(edge);
  loop.end = cuts_.count;
  loop.alone_end = alone_first_.count;
  loop.area = 0.5 * area;
  loop.moment = {moment[0] / 6, moment[1] / 6};
  loop.volume = volume / 6;
  loop.least = {least[0], least[1]};
  loop.most = {most[0], most[1]};
  loops_.push_back(loop);
}

}  // namespace affskel::core
