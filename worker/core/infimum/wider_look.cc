#include "core/infimum/wider_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/base/none.h"
#include "core/infimum/saddle_search.h"
#include "core/infimum/section_loops.h"

namespace affskel::core {
namespace {

constexpr std::size_t kNearest = 6;  // saddles nearest to x that are tried: pockets between them are small
constexpr std::size_t kMostSaddles = 2 * (NearPlaces::kMost + 1) + kNearest;
// Sine of the angle between the known plane and those that touch any saddle.  Of so many triangles; with more it is
// less, as there are more saddles, in proportion, and a piece takes longer, by the root.
constexpr double kReach = 0.6, kReachTriangles = 700;
// What the first piece of a plane may be, in known ones: of pairs, of those that touch any saddle, of near places'.
constexpr double kPairFirst = 1, kReachFirst = 2, kNearFirst = 3;
// What a near place's plane may promise, likewise; and what more of up to so many triangles, with more it is less by
// the square, as a piece takes longer: one that touches two saddles, others.
constexpr double kMostPromised = 1.01, kMoreOfPair = 0.09, kMoreOfOther = 0.04, kPromiseTriangles = 1000;
// And more by so much, at most 1, times the fourth power of the change of E^(1/3) on the way, as a share: where that
// is great, near the surface, a place's normal is of no use one step on, and neither is what it promises.
constexpr double kBend = 0.1;
// A near place's plane that promises so little, in known pieces, is followed to the end, whatever it cuts off at first.
constexpr double kFarLess = 0.25;
// 1 - cosine of planes that touch the same saddles and lead to one piece: of the known one. More of many triangles.
constexpr double kOneBasin = 0.005, kMoreBasin = 0.015;
constexpr double kLesser = 1e-7;  // by which a piece must be less to take the place of another
constexpr double kPairPromise = 4, kNearPromise = 1, kBendPromise = 4;  // DescentBound::promise
constexpr double kAnyPiece = std::numeric_limits<double>::infinity();   // as a bound

double generosity(std::size_t triangles) {
  const double share = kPromiseTriangles / std::max(kPromiseTriangles, static_cast<double>(triangles));
  return share * share;
}

double reach(std::size_t triangles) {
  const double share = kReachTriangles / std::max(kReachTriangles, static_cast<double>(triangles));
  return kReach * share * std::sqrt(share);
}

class Look {
 public:
  Look(const PieceInput& input, const Vec3& x, std::uint32_t point, const NearPlaces& near,
       const std::vector<LeastChord>& least, const std::function<bool(std::uint32_t)>& is_news,
       ChordDescent& descent)
      : in_(input),
        x_(x),
        generosity_(generosity(input.mesh.triangles.size())),
        known_(least[point]),
        best_(known_),
        near_(near),
        least_(least),
        is_news_(is_news),
        descent_(descent) {
    list_saddles(is_news(point));
  }

  LeastChord run() {
    try_planes();
    try_pairs();
    try_reach();
    return best_.erosion < known_.erosion ? descent_.look_across(x_, best_) : known_;
  }

 private:
  struct Saddle {
    const PieceInput::Saddle* of = nullptr;
    Vec3 way;            // to it from x, of unit length
    bool below = false;  // the known plane
    bool anew = false;   // not tried yet
  };

  Saddle saddle(const PieceInput::Saddle& of, bool anew) const {
    const Vec3 from_x = in_.mesh.points[of.vertex] - x_;
    return {&of, (1 / norm(from_x)) * from_x, dot(known_.normal, from_x) < -kTouchHeight, anew};
  }

  std::span<Saddle> known_saddles() { return std::span(saddles_).first(count_); }

  void add(std::uint32_t vertex, bool anew) {
    if (vertex == kNone) return;
    const auto known = known_saddles();
    const auto there = std::ranges::find_if(known, [&](const Saddle& s) { return s.of->vertex == vertex; });
    if (there != known.end()) {
      there->anew = there->anew || anew;
    } else {
      const auto of = std::ranges::lower_bound(in_.saddles, vertex, {}, &PieceInput::Saddle::vertex);
      saddles_[count_++] = saddle(*of, anew);
    }
  }

  // Of the known plane and of near places' planes, and the nearest ones.
  void list_saddles(bool anew) {
    for (const std::uint32_t s : known_.saddles) add(s, anew);
    near_.for_each([&](std::uint32_t q, const Vec3&) {
      for (const std::uint32_t s : least_[q].saddles) add(s, anew || is_news_(q));
    });
    for (const SaddleSearch::Saddle& s : descent_.saddles().nearest(x_, kNearest)) add(s.vertex, anew);
  }

  void try_pairs() {
    for (std::size_t m = 0; m < count_; ++m) {
      for (std::size_t n = 0; n < m; ++n) {
        const Saddle &a = saddles_[m], &b = saddles_[n];
        if (!(a.anew || b.anew) || !leaves_out(a, b)) continue;
        const Vec3 across = cross(a.way, b.way);
        try_pair(a, b, across, kPairFirst);
        try_pair(a, b, -1 * across, kPairFirst);
      }
    }
  }

  // Planes that touch one of the saddles and any other, not far from the known plane.
  void try_reach() {
    if (std::ranges::none_of(known_saddles(), &Saddle::anew)) return;
    const double sine = reach(in_.mesh.triangles.size());
    const double cosine_squared = 1 - sine * sine;
    std::array<const Saddle*, kMostSaddles> near;
    std::size_t near_count = 0;
    for (const Saddle& a : known_saddles()) {
      if (std::abs(dot(a.way, known_.normal)) <= sine) near[near_count++] = &a;
    }
    for (const PieceInput::Saddle* other : descent_.saddles().in_reach(x_, known_.normal, sine)) {
      const Saddle b = saddle(*other, false);
      const Vec3 turned = cross(b.way, known_.normal);
      for (std::size_t m = 0; m < near_count; ++m) {
        const Saddle& a = *near[m];
        if (a.of == other) break;  // a pair that is tried
        if (!a.anew || !leaves_out(a, b)) continue;
        const double along = dot(a.way, turned), shared = dot(a.way, b.way);
        if (along * along < cosine_squared * (1 - shared * shared)) continue;
        const Vec3 across = cross(a.way, b.way);
        try_pair(a, b, along < 0 ? -1 * across : across, kReachFirst);
      }
    }
  }

  // A lesser piece leaves out a part that the known one has.
  static bool leaves_out(const Saddle& a, const Saddle& b) { return a.below || b.below; }

  void try_pair(const Saddle& a, const Saddle& b, const Vec3& across, double first) {
    if (!near_tangent(a, across) || !near_tangent(b, across)) return;
    if (near_.holds_more(across, best_.erosion)) return;
    const double size = norm(across);
    if (!(size > 0)) return;
    LeastChord start;
    start.normal = (1 / size) * across;
    start.saddles = {std::min(a.of->vertex, b.of->vertex), std::max(a.of->vertex, b.of->vertex)};
    if ((start.saddles == best_.saddles && alike(start, best_)) || is_tried(start)) return;
    if (joins(a, start.normal) && joins(b, start.normal)) go_down(start, first, kPairPromise);
  }

  bool near_tangent(const Saddle& saddle, const Vec3& d) const {
    return descent_.saddles().near_tangent(*saddle.of, d);
  }
  bool joins(const Saddle& saddle, const Vec3& d) { return descent_.saddles().may_join(x_, *saddle.of, d); }

  void try_planes() {
    near_.for_each([&](std::uint32_t q, const Vec3& way) {
      if (is_news_(q)) try_plane_of(least_[q], way);
    });
  }

  void try_plane_of(const LeastChord& offer, const Vec3& way) {
    if (offer.saddles == best_.saddles &&
        dot(offer.normal, best_.normal) > 1 - kOneBasin - kMoreBasin * (1 - generosity_))
      return;
    const double share = promised(offer, -1 * way) / best_.erosion;
    if (share > most_promised(offer, way) || is_tried(offer)) return;
    tried_[tries_++] = &offer;
    if (share < kFarLess) {
      go_down(offer, kAnyPiece, kAnyPiece);
    } else if (!near_.holds_more(touching(offer), best_.erosion)) {
      go_down(offer, kNearFirst, kNearPromise + kBendPromise * bend(way));
    }
  }

  double most_promised(const LeastChord& offer, const Vec3& way) const {
    return kMostPromised + generosity_ * (offer.kind() == 2 ? kMoreOfPair : kMoreOfOther) + bend(way);
  }

  double bend(const Vec3& way) const {
    const double change = norm(way) * known_.slope / (3 * known_.erosion), square = change * change;
    return generosity_ * std::min(1.0, kBend * square * square);
  }

  bool is_tried(const LeastChord& start) const {
    return std::any_of(tried_.begin(), tried_.begin() + tries_, [&](const LeastChord* tried) {
      return tried->saddles == start.saddles && alike(*tried, start);
    });
  }

  // A normal, of any length, of the plane nearest to a near place's that touches its saddles.
  Vec3 touching(const LeastChord& offer) const {
    const Vec3& d = offer.normal;
    if (offer.kind() == 0) return d;
    const Vec3 s = in_.mesh.points[offer.saddles[0]] - x_;
    if (offer.kind() == 1) return d - (dot(d, s) / dot(s, s)) * s;
    const Vec3 across = cross(s, in_.mesh.points[offer.saddles[1]] - x_);
    return dot(across, d) < 0 ? -1 * across : across;
  }

  void go_down(const LeastChord& start, double first, double promise) {
    const double less = best_.erosion * (1 - kLesser);
    const LeastChord found = descent_.descend(x_, start, {first * best_.erosion, less, promise});
    if (found.erosion < less) best_ = found;
  }

  const PieceInput& in_;
  const Vec3 x_;
  const double generosity_;
  const LeastChord known_;
  LeastChord best_;
  const NearPlaces& near_;
  const std::vector<LeastChord>& least_;
  const std::function<bool(std::uint32_t)>& is_news_;
  ChordDescent& descent_;
  std::array<Saddle, kMostSaddles> saddles_;
  std::size_t count_ = 0;
  std::array<const LeastChord*, NearPlaces::kMost> tried_;
  std::size_t tries_ = 0;
};

}  // namespace

LeastChord look_wider(const PieceInput& input, const Vec3& x, std::uint32_t point, const NearPlaces& near,
                      const std::vector<LeastChord>& least, const std::function<bool(std::uint32_t)>& is_news,
                      ChordDescent& descent) {
  return Look(input, x, point, near, least, is_news, descent).run();
}

}  // namespace affskel::core
