#include "core/infimum/section_loops.h"

#include <algorithm>
#include <limits>

namespace affskel::core {
namespace {

// Two unit vectors that form a right-handed basis with d (Duff et al. 2017).
void make_basis(const Vec3& d, Vec3& u, Vec3& w) {
  const double sign = d.z >= 0 ? 1 : -1;
  const double s = -1 / (sign + d.z), m = d.x * d.y * s;
  u = {1 + sign * d.x * d.x * s, sign * m, -sign * d.x};
  w = {m, sign + d.y * d.y * s, -d.y};
}

// By sides_of(): the corner below whose next one is above.
constexpr std::array<std::uint32_t, 8> kRisingEdge = {0, 0, 1, 1, 2, 0, 2, 0};

}  // namespace

SectionLoops::SectionLoops(const PieceInput& input) : in_(input), mark_(input.mesh.triangles.size(), 0) {}

void SectionLoops::cut(const Vec3& x, const Vec3& d) {
  x_ = x;
  d_ = d;
  make_basis(d, u_, w_);
  collect();
  loops_.clear();
  cuts_.clear();
  tree_edges_.resize(found_.size());
  tree_edge_count_ = 0;
  handle_edges_.clear();
  traced_.assign(found_.size(), 0);
  for (std::uint32_t i = 0; i < found_.size(); ++i) {
    if (traced_[i] == 0) trace(i);
  }
  tree_edges_.resize(tree_edge_count_);
  first_mark_ += static_cast<std::uint32_t>(found_.size());
}

void SectionLoops::collect() {
  const PlaneHeights plane(x_, d_);
  const auto meets = [&](const FourBoxes& boxes) {
    const Four middle = plane.middle(boxes), reach = plane.reach(boxes);
    return (middle <= reach) & (middle >= -reach);
  };
  in_.tree.select(meets, near_);
  found_.resize(near_.size());
  std::size_t count = 0;
  for (const std::uint32_t t : near_) {
    const Triangle& c = in_.mesh.triangles[t];
    Cut& cut = found_[count];
    cut.triangle = t;
    cut.height = {height(c[0]), height(c[1]), height(c[2])};
    const unsigned sides = sides_of(cut.height);
    cut.edge = kRisingEdge[sides];
    count += static_cast<std::size_t>((0x7EU >> sides) & 1U);
  }
  found_.resize(count);
  if (first_mark_ > std::numeric_limits<std::uint32_t>::max() - found_.size() - 1) {
    std::fill(mark_.begin(), mark_.end(), 0);
    first_mark_ = 1;
  }
  for (std::uint32_t i = 0; i < found_.size(); ++i) mark_[found_[i].triangle] = first_mark_ + i;
}

void SectionLoops::trace(std::uint32_t start) {
  const auto index = static_cast<std::uint32_t>(loops_.size());
  Loop loop;
  loop.begin = static_cast<std::uint32_t>(cuts_.size());
  loop.shell = in_.shell_of[in_.mesh.triangles[found_[start].triangle][0]];
  for (std::uint32_t i = start; traced_[i] == 0;) {
    traced_[i] = 1;
    Cut& cut = cuts_.emplace_back(found_[i]);
    const std::uint32_t next = (cut.edge + 1) % 3, half_edge = 3 * cut.triangle + cut.edge;
    const Triangle& c = in_.mesh.triangles[cut.triangle];
    const std::uint32_t low = c[cut.edge], high = c[next];
    const double low_height = cut.height[cut.edge], high_height = std::max(cut.height[next], 0.0);
    const Vec3& p = in_.mesh.points[low];
    const Vec3 y = (p - x_) + (low_height / (low_height - high_height)) * (in_.mesh.points[high] - p);
    const PlanePoint at{dot(u_, y), dot(w_, y)};
    cut.leaves = at;
    loop.high_a = std::max(loop.high_a, at.a);
    loop.low_b = std::min(loop.low_b, at.b);
    loop.high_b = std::max(loop.high_b, at.b);
    if (high_height > kTouchHeight && at.a > loop.rightmost.a) loop.rightmost = at;
    const std::uint32_t child = std::max(low, high);
    tree_edges_[tree_edge_count_] = {child, index, child == low};
    tree_edge_count_ += in_.parent[child] == std::min(low, high) ? 1 : 0;
    if (!in_.at_handle.empty() && in_.at_handle[half_edge] != 0) handle_edges_.emplace_back(low, index);
    i = mark_[in_.mates[half_edge] / 3] - first_mark_;
  }
  loop.end = static_cast<std::uint32_t>(cuts_.size());
  loops_.push_back(loop);
}

}  // namespace affskel::core
