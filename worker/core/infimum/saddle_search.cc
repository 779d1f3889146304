#include "core/infimum/saddle_search.h"

#include <algorithm>
#include <cmath>

#include "core/infimum/section_loops.h"

namespace affskel::core {
namespace {

constexpr double kFurthestTilt = 0.1;
// Of this many triangles.  With more the tilt is less, so that its vertices grow in number as a rim's do.
constexpr double kTriangles = 1000;
constexpr double kLevel = 4 * kTouchHeight;  // height of a vertex in the plane, within rounding
constexpr std::size_t kMostLooks = 400;      // at vertices round a crossing, some several times

}  // namespace

SaddleSearch::SaddleSearch(const PieceInput& input)
    : in_(input),
      furthest_(
          kFurthestTilt *
          std::sqrt(kTriangles / std::max(kTriangles, static_cast<double>(input.mesh.triangles.size())))),
      seen_by_(input.crossings.empty() ? 0 : input.mesh.points.size(), 0) {}

template <class Meets, class Visit>
void SaddleSearch::visit_vertices(Meets meets, Visit visit) {
  for (const std::uint32_t i : in_.saddle_tree.select(meets, lists_)) visit(in_.saddles[i]);
}

const std::vector<SaddleSearch::Saddle>& SaddleSearch::sinking(const Vec3& x, const Vec3& d, const Vec3& end,
                                                               std::span<const std::uint32_t> but) {
  x_ = x;
  found_.clear();
  const PlaneHeights now(x, d), then(x, end);
  const auto meets = [&](const FourBoxes& boxes) {
    return (now.middle(boxes) >= -now.reach(boxes)) & (then.middle(boxes) <= then.reach(boxes));
  };
  visit_vertices(meets, [&](const PieceInput::Saddle& saddle) {
    const std::uint32_t v = saddle.vertex;
    const Vec3 y = from_x(v);
    const double now_height = dot(d, y), then_height = dot(end, y);
    if (now_height < -kTouchHeight || then_height >= -kTouchHeight) return;
    if (std::find(but.begin(), but.end(), v) != but.end()) return;
    const double at = std::max(0.0, now_height / (now_height - then_height));
    if (may_join(saddle, d + at * (end - d))) found_.push_back({at, v});
  });
  std::sort(found_.begin(), found_.end());
  return found_;
}

const std::vector<SaddleSearch::Saddle>& SaddleSearch::just_below(const Vec3& x, const Vec3& d) {
  x_ = x;
  found_.clear();
  const PlaneHeights plane(x, d);
  const auto tilt = static_cast<float>(furthest_);
  const auto meets = [&](const FourBoxes& boxes) {
    const Four middle = plane.middle(boxes), reach = plane.reach(boxes);
    return (middle <= reach) & (middle + reach >= -tilt * PlaneHeights::distance(boxes, x));
  };
  visit_vertices(meets, [&](const PieceInput::Saddle& saddle) {
    const std::uint32_t v = saddle.vertex;
    const Vec3 y = from_x(v);
    const double height = dot(d, y), square = dot(y, y);
    if (height >= -kTouchHeight || height * height > furthest_ * furthest_ * square) return;
    if (may_join(saddle, d - (height / square) * y)) found_.push_back({-height / std::sqrt(square), v});
  });
  std::sort(found_.begin(), found_.end());
  return found_;
}

const std::vector<SaddleSearch::Saddle>& SaddleSearch::nearest(const Vec3& x, std::size_t count) {
  x_ = x;
  count = std::min(count, in_.saddles.size());
  while (true) {
    found_.clear();
    const auto within = static_cast<float>(radius_);
    visit_vertices([&](const FourBoxes& boxes) { return PlaneHeights::gap(boxes, x) <= within; },
                   [&](const PieceInput::Saddle& saddle) {
                     const Vec3 y = from_x(saddle.vertex);
                     const double square = dot(y, y);
                     if (square <= radius_ * radius_) found_.push_back({square, saddle.vertex});
                   });
    if (found_.size() >= count) break;
    radius_ *= 2;
  }
  if (found_.size() > 4 * count) radius_ *= 0.75;
  std::partial_sort(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(count), found_.end());
  found_.resize(count);
  return found_;
}

std::span<const PieceInput::Saddle* const> SaddleSearch::in_reach(const Vec3& x, const Vec3& d, double sine) {
  x_ = x;
  reached_.clear();
  const PlaneHeights plane(x, d);
  const auto sine_squared = static_cast<float>(sine * sine);
  const double cosine = std::sqrt(1 - sine * sine);
  const auto meets = [&](const FourBoxes& boxes) {
    const Four middle = plane.middle(boxes);
    const Four away = (middle < 0 ? -middle : middle) - plane.reach(boxes);
    return (away <= 0) | (away * away <= sine_squared * PlaneHeights::distance_squared(boxes, x));
  };
  visit_vertices(meets, [&](const PieceInput::Saddle& saddle) {
    const Vec3 y = from_x(saddle.vertex);
    const double height = dot(d, y), along = dot(d, saddle.normal);
    if (height * height > sine * sine * dot(y, y)) return;
    const double least = saddle.cosine * cosine - saddle.sine * sine;  // of the sum of both angles
    if (least <= 0 || along * along >= least * least) reached_.push_back(&saddle);
  });
  return reached_;
}

bool SaddleSearch::may_join(const Vec3& x, const PieceInput::Saddle& saddle, const Vec3& d) {
  x_ = x;
  return may_join(saddle, d);
}

bool SaddleSearch::may_join(const PieceInput::Saddle& saddle, const Vec3& d) {
  return parts_ring(saddle, d) || crossing_joins(saddle.vertex, d);
}

bool SaddleSearch::parts_ring(const PieceInput::Saddle& saddle, const Vec3& d) const {
  if (!near_tangent(saddle, d)) return false;
  const auto ring = in_.rings[saddle.vertex];
  int changes = 0;
  bool before = dot(d, from_x(ring.back())) < 0;
  for (const std::uint32_t other : ring) {
    const double height = dot(d, from_x(other));
    if (std::abs(height) <= kLevel) return true;
    changes += (height < 0) != before;
    before = height < 0;
  }
  return changes >= 4;
}

// Whether parts meet in the triangles that begin with the vertex and pass through others, which have begun: among
// each other, or with what is round the vertex.
bool SaddleSearch::crossing_joins(std::uint32_t vertex, const Vec3& d) {
  meeting_.clear();
  for (const CrossingPairs::Crossing& crossing : in_.crossings.at(vertex)) {
    if (!begins_with(crossing.triangle, vertex, d)) continue;
    const Triangle& other = in_.mesh.triangles[crossing.other];
    if (uses(other, vertex)) continue;  // what is below of it is round the vertex
    const auto height = [&](std::uint32_t v) { return dot(d, from_x(v)); };
    const std::uint32_t lowest = *std::ranges::min_element(other, {}, height);
    if (std::abs(height(lowest)) <= kLevel) return true;
    if (height(lowest) < 0) meeting_.push_back(lowest);
  }
  if (meeting_.empty()) return false;
  const auto ring = in_.rings[vertex];
  const auto below =
      std::ranges::find_if(ring, [&](std::uint32_t other) { return dot(d, from_x(other)) < -kLevel; });
  if (below != ring.end()) meeting_.push_back(*below);
  return !are_near_below(meeting_, d);
}

bool SaddleSearch::begins_with(std::uint32_t triangle, std::uint32_t vertex, const Vec3& d) const {
  return std::ranges::all_of(in_.mesh.triangles[triangle], [&](std::uint32_t other) {
    return other == vertex || dot(d, from_x(other)) >= -kLevel;
  });
}

// Whether vertices below the plane are joined by few edges and crossings below it.
bool SaddleSearch::are_near_below(std::span<const std::uint32_t> vertices, const Vec3& d) {
  seen_.clear();
  if (++look_ == 0) {
    std::fill(seen_by_.begin(), seen_by_.end(), 0);
    look_ = 1;
  }
  std::size_t looks = 0;
  const auto see = [&](std::uint32_t v) {
    if (++looks > kMostLooks || seen_by_[v] == look_ || dot(d, from_x(v)) >= -kLevel) return;
    seen_by_[v] = look_;
    seen_.push_back(v);
  };
  const auto all_seen = [&] {
    return std::ranges::all_of(vertices, [&](std::uint32_t v) { return seen_by_[v] == look_; });
  };
  see(vertices[0]);
  for (std::size_t i = 0; i < seen_.size() && looks < kMostLooks && !all_seen(); ++i) {
    for (const std::uint32_t other : in_.rings[seen_[i]]) see(other);
    for (const CrossingPairs::Crossing& crossing : in_.crossings.at(seen_[i])) {
      for (const std::uint32_t other : in_.mesh.triangles[crossing.other]) see(other);
    }
  }
  return all_seen();
}

}  // namespace affskel::core
