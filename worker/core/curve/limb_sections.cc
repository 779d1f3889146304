#include "core/curve/limb_sections.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/basis.h"
#include "core/base/disjoint_sets.h"
#include "core/base/plain_math.h"
#include "core/mesh/box.h"
#include "core/spatial/ray_crossing.h"

namespace affskel::core {
namespace {

constexpr double kShort = 0.15;     // of rays: in a tube along one of the axes half of those across it
constexpr double kNear = 0.4;       // of the reach: as far as most of those are looked for
constexpr double kNothing = 1e-12;  // of the squared reach: a ray that short says nothing more

constexpr double kSlack = 1e-9;  // for rounding, of lengths
constexpr double kFar = std::numeric_limits<double>::infinity();
const Box kEverywhere{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};

// The boxes about a place that its plane goes through.
struct CutBoxes {
  Box round;
  const Vec3& place;
  const Vec3& across;
  bool is_flat;  // round: it lies in the plane

  bool meets(const Box& box) const {
    if (!round.meets(box)) return false;
    if (is_flat) return true;
    const Vec3 sides = box.sides();
    const double height = dot(across, box.middle() - place);  // of the box's middle above the plane
    const double half =
        0.5 * (std::abs(across.x) * sides.x + std::abs(across.y) * sides.y + std::abs(across.z) * sides.z);
    return std::abs(height) <= (1 + kSlack) * half;
  }
};

}  // namespace

LimbSections::LimbSections(const Mesh& surface, unsigned threads)
    : surface_(surface), tree_(boxes_of(surface), threads) {
  for (std::size_t n = 0; n < kRays; ++n) {
    const auto [sine, cosine] = plain_sin_cos_degrees((static_cast<double>(n) + 0.5) * 360 / kRays);
    turns_[n] = {cosine, sine};
  }
}

// Visits what a plane cuts of triangles, from edge to edge, relative to the place: the inside is on the left.
template <class Visit>
void LimbSections::cut(const Box& round, const Vec3& place, const Vec3& across, const Visit& visit) const {
  const Vec3 sides = round.sides();
  const bool is_flat = sides.x == 0 || sides.y == 0 || sides.z == 0;
  tree_.visit(CutBoxes{round, place, across, is_flat}, [&](std::uint32_t t) {
    const Triangle& triangle = surface_.triangles[t];
    std::array<Vec3, 3> corner;
    std::array<double, 3> height;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = surface_.points[triangle[k]] - place;
      height[k] = dot(corner[k], across);
    }
    std::array<Vec3, 2> ends;
    std::array<Segment, 2> edges;
    int count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if ((height[k] < 0) == (height[next] < 0)) continue;
      const std::size_t end = height[k] < 0 ? 1 : 0;
      // From the same corner for both triangles of an edge: ends that differ by rounding would leave a gap.
      const auto [p, q] = triangle[k] < triangle[next] ? std::pair(k, next) : std::pair(next, k);
      ends[end] = corner[p] + (height[p] / (height[p] - height[q])) * (corner[q] - corner[p]);
      edges[end] = ascending(triangle[k], triangle[next]);
      ++count;
    }
    if (count == 2) visit(ends, edges);
  });
}

double LimbSections::height_above(std::size_t ray, const Turn& p) const {
  return turns_[ray][0] * p[1] - turns_[ray][1] * p[0];
}

// Of the rays of a half turn those before the place, by its angle, have it on one side, those after it on the other, and
// opposite rays have it on opposite ones.  Without branches, which no processor could guess.
std::uint32_t LimbSections::rays_left_of(const Turn& p) const {
  const bool upper = p[1] >= 0;
  const auto is_before = [&](std::size_t n) -> std::size_t { return (height_above(n, p) < 0) != upper; };
  static_assert(std::has_single_bit(kRays));
  std::size_t before = 0;
  for (std::size_t step = kRays / 4; step > 0; step /= 2) before += step * is_before(before + step - 1);
  before += is_before(before);
  constexpr std::uint32_t kHalf = (1U << kRays / 2) - 1;
  const std::uint32_t first = upper ? kHalf & kHalf << before : kHalf >> (kRays / 2 - before);
  return first | (~first & kHalf) << kRays / 2;
}

LimbSections::Rays LimbSections::outline(const Vec3& place, const Vec3& u, const Vec3& v,
                                         double reach) const {
  Rays length;
  length.fill(reach);
  const Vec3 across = cross(u, v);
  Box round = Box{place, place}.widened(reach);
  for (std::size_t k = 0; k < 3; ++k)  // across an axis, exactly: a flat box tells sooner
    if (across[(k + 1) % 3] == 0 && across[(k + 2) % 3] == 0) round.low[k] = round.high[k] = place[k];
  cut(round, place, across, [&](const auto& ends, const auto&) {
    const Turn p{dot(ends[0], u), dot(ends[0], v)}, q{dot(ends[1], u), dot(ends[1], v)};
    for (std::uint32_t between = rays_left_of(p) ^ rays_left_of(q); between != 0; between &= between - 1) {
      const auto n = static_cast<std::size_t>(std::countr_zero(between));
      const double left = height_above(n, p), right = height_above(n, q);
      const double part = left / (left - right);
      const double way =
          turns_[n][0] * (p[0] + part * (q[0] - p[0])) + turns_[n][1] * (p[1] + part * (q[1] - p[1]));
      if (way >= 0) length[n] = std::min(length[n], way);
    }
  });
  Rays sorted = length;
  std::nth_element(sorted.begin(), sorted.begin() + kRays / 2, sorted.end());
  for (double& way : length) way = std::min(way, kWidest * sorted[kRays / 2]);
  return length;
}

LimbSection LimbSections::at(const Vec3& place, const Vec3& across, double ball) const {
  const Vec3 u = unit_beside(across), v = cross(across, u);
  const Rays length = outline(place, u, v, kSeen * ball);
  double squares = 0;
  Vec3 moment;
  for (std::size_t n = 0; n < kRays; ++n) {
    const double way = length[n];
    squares += way * way;
    moment = moment + (2.0 / 3 * way * way * way) * (turns_[n][0] * u + turns_[n][1] * v);
  }
  if (!(squares > 0)) return {place, 0};
  return {place + (1 / squares) * moment, std::sqrt(squares / static_cast<double>(kRays))};
}

// Outlines about a place lie within each other, where the surface does not cross itself: one that lies in a box has none
// within that leave it.
double LimbSections::area(const Vec3& place, const Vec3& across, double ball) const {
  for (const double balls : {kSeen, kSeen * kSeen}) {
    const double found = least_outline(Box{place, place}.widened(balls * ball), place, across);
    if (found > 0) return found;
  }
  return least_outline(kEverywhere, place, across);
}

double LimbSections::least_outline(const Box& round, const Vec3& place, const Vec3& across) const {
  const Vec3 u = unit_beside(across), v = cross(across, u);
  struct Side {
    std::array<Segment, 2> edges;
    double area = 0;
    int turns = 0;  // about the place
    bool is_within = true;
  };
  std::vector<Side> sides;
  std::vector<Segment> edges;
  cut(round, place, across, [&](const auto& ends, const auto& of) {
    const double a = dot(ends[0], u), b = dot(ends[0], v), c = dot(ends[1], u), d = dot(ends[1], v);
    const double turn = a * d - b * c;
    Side side{of, 0.5 * turn};
    if ((b < 0) != (d < 0) && (turn > 0) == (d > b)) side.turns = d > b ? 1 : -1;
    for (const Vec3& end : ends)
      side.is_within = side.is_within && round.meets(Box{place + end, place + end});
    sides.push_back(side);
    edges.insert(edges.end(), of.begin(), of.end());
  });
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const auto number = [&](const Segment& edge) {
    return static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
  };
  DisjointSets outlines(edges.size());
  for (const Side& side : sides) outlines.unite(number(side.edges[0]), number(side.edges[1]));
  std::vector<Side> whole(edges.size());
  for (const Side& side : sides) {
    Side& outline = whole[outlines.find(number(side.edges[0]))];
    outline.area += side.area;
    outline.turns += side.turns;
    outline.is_within = outline.is_within && side.is_within;
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Side& outline : whole)
    if (outline.turns > 0 && outline.area > 0 && outline.is_within) least = std::min(least, outline.area);
  return std::isfinite(least) ? least : 0;
}

LimbEllipse LimbSections::ellipse(const Vec3& place, const Vec3& u, const Vec3& v, double ball) const {
  const double reach = kSeen * ball;
  const Rays length = outline(place, u, v, reach);
  LimbEllipse ellipse;
  for (std::size_t n = 0; n < kRays; ++n) {
    const double one = 1 / (kRays * std::max(length[n] * length[n], kNothing * reach * reach));
    const auto [x, y] = turns_[n];
    ellipse.mean += one;
    ellipse.cosine += 2 * one * (x * x - y * y);
    ellipse.sine += 4 * one * x * y;
  }
  constexpr double kMost = (kFlattest * kFlattest - 1) / (kFlattest * kFlattest + 1);
  const double flatness =
      std::sqrt(ellipse.cosine * ellipse.cosine + ellipse.sine * ellipse.sine) / ellipse.mean;
  if (flatness > kMost) {
    ellipse.cosine *= kMost / flatness;
    ellipse.sine *= kMost / flatness;
  }
  return ellipse;
}

// Rays as long as that are mostly not needed.  Nor does it matter that rays are at most twice as long as the middle one of
// their plane: more than kShort of all are shorter than that one.
double LimbSections::thickness(const Vec3& place, double ball) const {
  const double reach = kSeen * ball, near = kNear * reach, found = shortest_rays(place, near);
  return found < near ? found : shortest_rays(place, reach);
}

double LimbSections::shortest_rays(const Vec3& place, double reach) const {
  std::array<double, 3 * kRays> all;
  for (std::size_t k = 0; k < 3; ++k) {
    const Rays length = outline(place, kIdentity3[k], kIdentity3[(k + 1) % 3], reach);
    std::copy(length.begin(), length.end(), all.begin() + k * kRays);
  }
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(kShort * static_cast<double>(all.size()));
  std::nth_element(all.begin(), at, all.end());
  return *at;
}

std::optional<Vec3> LimbSections::parted(const Vec3& a, const Vec3& b) const {
  const Vec3 way = b - a;
  double first = 1, last = 0;
  if (way == Vec3{}) return std::nullopt;
  const CrossedLine line(a, way);
  tree_.visit(WayQuery{a, way, kSlack * largest_component(way)}, [&](std::uint32_t t) {
    const auto crossing = line.with(surface_, surface_.triangles[t]);
    if (!crossing || !(crossing->part >= 0 && crossing->part <= 1)) return;
    first = std::min(first, crossing->part);
    last = std::max(last, crossing->part);
  });
  if (last < first) return std::nullopt;
  return a + 0.5 * (first + last) * way;
}

double LimbEllipse::radius() const {
  return 1 / std::sqrt(std::sqrt(mean * mean - cosine * cosine - sine * sine));
}

}  // namespace affskel::core
