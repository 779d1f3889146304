#include "core/infimum/section_loops.h"

#include <algorithm>
#include <limits>

#include "core/base/basis.h"

namespace affskel::core {

SectionLoops::SectionLoops(const PieceInput& input) : in_(input), passed_(input.edges.size(), 0) {}

// Every loop passes one of the input's edges: what they leave of a shell is a disc without a vertex inside it,
// and a loop has vertices on both sides.
void SectionLoops::cut(const Vec3& x, const Vec3& d) {
  x_ = x;
  d_ = d;
  make_basis(d, u_, w_);
  axes_ = {Two{u_.x, w_.x}, Two{u_.y, w_.y}, Two{u_.z, w_.z}};
  loops_.clear();
  cuts_.clear();
  edges_.clear();
  if (++number_ == 0) {
    std::fill(passed_.begin(), passed_.end(), 0);
    number_ = 1;
  }
  const PlaneHeights plane(x, d);
  const auto meets = [&](const FourBoxes& boxes) {
    const Four middle = plane.middle(boxes), reach = plane.reach(boxes);
    return (middle <= reach) & (middle >= -reach);
  };
  for (const std::uint32_t n : in_.edge_tree.select(meets, lists_)) {
    const PieceInput::Edge& edge = in_.edges[n];
    if (passed_[n] == number_) continue;
    const bool begin_below = below(edge.begin);
    if (begin_below != below(edge.end)) trace(begin_below ? edge.there : edge.back);
  }
}

inline SectionLoops::Corner SectionLoops::corner(std::uint32_t vertex) const {
  const Vec3 y = in_.mesh.points[vertex] - x_;
  return {axes_[0] * y.x + axes_[1] * y.y + axes_[2] * y.z, dot(d_, y), vertex};
}

// Where the edge between two vertices, the first below, passes the plane.
inline SectionLoops::Two SectionLoops::passed(const Corner& low, const Corner& high) {
  return low.at + low.height / (low.height - high.height) * (high.at - low.at);
}

// From the half-edge that rises, triangle by triangle, until it comes back.
void SectionLoops::trace(std::uint32_t start) {
  const auto index = static_cast<std::uint32_t>(loops_.size());
  // Corners above have heights of at least 0.
  Corner low = corner(in_.begin_of(start)), high = corner(in_.end_of(start));
  high.height = std::max(high.height, 0.0);
  Loop loop;
  loop.begin = static_cast<std::uint32_t>(cuts_.size());
  loop.low = low.vertex;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Two last = passed(low, high), least{kFar, kFar}, most = -least, moment{};  // moment six times
  double area = 0;                                                           // twice
  std::uint32_t h = start;
  do {
    const PieceInput::Passage& passage = in_.passages[h];
    if (passage.edge != PieceInput::kNone) {
      passed_[passage.edge] = number_;
      edges_.push_back({passage.edge, index, in_.edges[passage.edge].there == h});
    }
    const Corner apex = corner(passage.apex);
    Cut& cut = cuts_.emplace_back();
    // A branch, so that processors go on with a guess: to wait for the height takes longer.
    if (apex.height < -kTouchHeight) {
      cut.alone = high.height;
      cut.others = {-low.height, -apex.height};
      cut.corner = high.vertex;
      cut.corner_below = false;
      low = apex;
      h = passage.when_below;
    } else {
      cut.alone = -low.height;
      cut.others = {high.height, std::max(apex.height, 0.0)};
      cut.corner = low.vertex;
      cut.corner_below = true;
      high = apex;
      high.height = cut.others[1];
      h = passage.when_above;
    }
    cut.edge = h;
    const Two at = passed(low, high);
    cut.leaves = {at[0], at[1]};
    const double turn = last[0] * at[1] - at[0] * last[1];
    area += turn;
    moment += turn * (last + at);
    last = at;
    least = at < least ? at : least;
    most = at > most ? at : most;
    if (high.height > kTouchHeight && at[0] > loop.rightmost.a) loop.rightmost = cut.leaves;
  } while (h != start);
  loop.area = 0.5 * area;
  loop.moment = {moment[0] / 6, moment[1] / 6};
  loop.high_a = most[0];
  loop.low_b = least[1];
  loop.high_b = most[1];
  loop.end = static_cast<std::uint32_t>(cuts_.size());
  loops_.push_back(loop);
}

}  // namespace affskel::core
