#include "core/curve/line_ends.h"

#include <algorithm>
#include <optional>

#include "core/base/unit.h"

namespace affskel::core {
namespace {

constexpr double kSteep = 0.5;   // see draw_end()
constexpr double kEndMoves = 3;  // spacings: how far from where a tip is known to lie about it is looked for
constexpr double kBaseline = 2;  // spacings: over less, the lattice's steps tell more than the line

// Radii of a section, from an end: what may lead to a corner of it, and what mostly does, if the line is short: of its
// way to the joint at most that share.
constexpr double kCorner = 2, kNearCorner = 1.5, kInner = 0.6;
constexpr double kTurned = 0.87;  // cosine of 30 degrees: less where it does
// Of a limb that turns before its tip: what of the ball there that a radius before its end has, or, flatter than so many balls
// and as large in its corners, how much of the line's way is reached straight on, at most.
constexpr double kStays = 0.85, kFlat = 1.15, kReaches = 0.65;
constexpr double kOfPlate = 1.7;  // as kFlat: sections end at two balls there
// Straight on, in a tube: the ball at the end over that at the start; where it is less, there is the wall.
constexpr double kLeadsOn = 0.75;
constexpr double kWider = 1.1;  // times: no bar's end, but a head or a foot

constexpr double kFace = 1.5;  // balls: how far the surface is from the centre of an end, at most
// Of a tube as long, what an end has: up to the one it is round, from the other on flat.
constexpr double kRoundEnd = 0.78, kFlatEnd = 0.9;

class DrawEnd {
 public:
  DrawEnd(const LineEndInput& input, std::vector<Vec3>& places) : in_(input), places_(places) {}

  void run() {
    const std::size_t first =
        first_away([&](std::size_t, double way) { return way < kEndMoves * in_.spacing; });
    if (const std::optional<Start> before_corner = start_before_corner(first)) return draw(*before_corner);
    const std::size_t inner =
        first_away([&](std::size_t n, double way) { return n < first || (way < ball(n) && is_in_end(n)); });
    const std::size_t start = inner < straight() ? inner : first;
    draw({start, outward_at(start)});
  }

 private:
  const Vec3& at(std::size_t n) const { return places_[in_.line[n]]; }

  double ball(std::size_t n) const { return in_.surface.distance.nearest(at(n)); }

  // Vertices before the joint.
  std::size_t straight() const { return in_.line.size() - std::min(in_.in_joint + 1, in_.line.size()); }

  // Whether the distance to the surface grows there as it does out of a blunt end, in which a line may lead aside.
  bool is_in_end(std::size_t n) const {
    std::size_t next = n;
    while (next + 1 < in_.line.size() && norm(at(next) - at(n)) < kBaseline * in_.spacing) ++next;
    return ball(next) - ball(n) > kSteep * norm(at(next) - at(n));
  }

  Vec3 outward_at(std::size_t n) const {
    return outward(places_, in_.line.subspan(n), ball(n) + in_.spacing, 0);
  }

  LimbSection section(const Vec3& place, const Vec3& across) const {
    return in_.surface.sections.at(place, across, in_.surface.distance.nearest(place));
  }

  template <class IsNear>
  std::size_t first_away(const IsNear& is_near) const {
    std::size_t n = 0;
    while (n + 2 < in_.line.size() && is_near(n, norm(at(n) - at(0)))) ++n;
    return n;
  }

  // From where on a line is in the middle, and its direction there.
  struct Start {
    std::size_t first;
    Vec3 along;
  };

  // Straight on from there.
  void draw(const Start& start) {
    const auto& [first, along] = start;
    if (along == Vec3{}) return;
    const Vec3 from = at(first);
    double way = to_centre(from, along);
    way += to_face(from + way * along, along);
    const std::size_t count = std::max<std::size_t>(first, 1);
    for (std::size_t n = 0; n < count; ++n)
      places_[in_.line[n]] =
          from + (way * static_cast<double>(count - n) / static_cast<double>(count)) * along;
  }

  // Where a line that leads into a corner leaves the middle.
  // @param first vertices, which may be of the end.
  std::optional<Start> start_before_corner(std::size_t first) const {
    const std::size_t inner = first_away([&](std::size_t n, double way) {
      const double radius = section(at(n), outward_at(n)).radius;
      return n < first || way < kNearCorner * radius ||
             (way < kCorner * radius && static_cast<double>(n) < kInner * static_cast<double>(straight()));
    });
    if (inner >= straight()) return std::nullopt;
    const double stretch =
        std::min(kCorner * section(at(inner), outward_at(inner)).radius, norm(at(straight()) - at(inner)));
    const Vec3 along = outward(places_, in_.line.subspan(inner), stretch, -stretch);
    if (along == Vec3{}) return std::nullopt;
    const double radius = section(at(inner), along).radius;
    if (goes_straight_on(first, inner, along, radius)) return std::nullopt;
    if (turns(inner, along, radius)) return std::nullopt;
    const double widest = kWider * radius;
    for (std::size_t n = 0; n < inner; ++n)
      if (section(at(n), along).radius > widest) return std::nullopt;
    return Start{inner, along};
  }

  // In a plate, which has no middle across but the line's, it may turn aside to its tip and back.
  bool goes_straight_on(std::size_t first, std::size_t from, const Vec3& along, double radius) const {
    if (dot(along, unit(at(0) - at(first))) <= kTurned) return false;
    for (std::size_t n = first; n < from && radius > kOfPlate * ball(from); ++n)
      if (dot(along, outward_at(n)) <= kTurned) return false;
    return true;
  }

  // Whether a line that turns beyond a vertex follows its limb there.
  bool turns(std::size_t from, const Vec3& along, double radius) const {
    const std::size_t before_end = first_away([&](std::size_t, double way) { return way < radius; });
    const double way = to_centre(at(from), along);
    const double ball_there = in_.surface.distance.nearest(at(from) + way * along);
    const bool follows = ball(before_end) > kStays * ball(from) || ball_there < kLeadsOn * ball(from);
    if (radius < kFlat * ball(from) && follows) return true;
    return way + ball_there < kReaches * norm(at(0) - at(from));
  }

  double to_centre(const Vec3& from, const Vec3& along) const {
    const double known = std::max({0.0, dot(in_.tip - from, along), dot(at(0) - from, along)});
    // The centre of a round end lies no farther beyond it than the surface.
    const double farthest =
        known + std::min(kEndMoves * in_.spacing, in_.surface.distance.nearest(from + known * along));
    double way = 0;
    while (way < farthest && in_.surface.membership.contains(from + (way + in_.spacing) * along) &&
           in_.surface.distance.nearest(from + way * along) -
                   in_.surface.distance.nearest(from + (way + in_.spacing) * along) <
               kSteep * in_.spacing)
      way += in_.spacing / 4;
    return way + in_.spacing / 2;
  }

  // How far a limb goes on beyond the centre of its end.
  double to_face(const Vec3& centre, const Vec3& along) const {
    const double step = in_.spacing / 8;
    const double ball = in_.surface.distance.nearest(centre);
    double reach = 0;
    while (reach < kFace * ball && in_.surface.membership.contains(centre + (reach + step) * along))
      reach += step;
    if (!(reach > 0) || reach >= kFace * ball) return 0;
    const auto square = [&](double part) {
      const double radius = in_.surface.sections.at(centre + part * reach * along, along, ball).radius;
      return radius * radius;
    };
    const double share = (square(0.25) + square(0.5) + square(0.75)) / (3 * square(0));
    return reach * std::clamp((share - kRoundEnd) / (kFlatEnd - kRoundEnd), 0.0, 1.0);
  }

  const LineEndInput& in_;
  std::vector<Vec3>& places_;
};

}  // namespace

Vec3 outward(std::span<const Vec3> places, std::span<const std::uint32_t> line, double stretch, double gap) {
  const auto go_on = [&](std::size_t n) {
    const Vec3 start = places[line[n]];
    while (norm(places[line[n]] - start) < stretch && n + 1 < line.size()) ++n;
    return n;
  };
  const std::size_t far = go_on(0), farther = go_on(far);
  const Vec3 here = places[line[0]] - places[line[far]], there = places[line[far]] - places[line[farther]];
  if (norm(there) < stretch) return unit(here);
  // Less where it turns less than half as much within the first stretch as an arc would: a corner farther on says nothing of its
  // beginning.
  constexpr double kTurns =
      4;  // an arc turns half as much from half to half of a stretch as from one to the next
  std::size_t half = 0;
  while (half < far && norm(places[line[half]] - places[line[0]]) < 0.5 * stretch) ++half;
  const Vec3 near = unit(places[line[0]] - places[line[half]]) - unit(places[line[half]] - places[line[far]]);
  const Vec3 turn = unit(here) - unit(there);
  const double share = norm(turn) > 0 ? std::min(1.0, kTurns * norm(near) / norm(turn)) : 0;
  return unit(unit(here) + (0.5 * (1 + gap / stretch) * share) * turn);
}

Vec3 direction_in_ball(std::span<const Vec3> places, std::span<const std::uint32_t> line, std::size_t n,
                       double ball) {
  const auto is_near = [&](std::size_t k) { return norm(places[line[k]] - places[line[n]]) < ball; };
  std::size_t low = n, high = n;
  while (low > 0 && is_near(low)) --low;
  while (high + 1 < line.size() && is_near(high)) ++high;
  return unit(places[line[high]] - places[line[low]]);
}

void draw_end(const LineEndInput& input, std::vector<Vec3>& places) {
  DrawEnd(input, places).run();
}

}  // namespace affskel::core
