#include "core/infimum/wider_look.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "core/infimum/saddle_search.h"
#include "core/infimum/section_loops.h"

namespace affskel::core {
namespace {

constexpr std::size_t kNearest = 6;  // saddles nearest to x that are tried
constexpr std::size_t kMostSaddles = 2 * (NearPlaces::kMost + 1) + kNearest;
constexpr double kNearFirst = 3;        // what the first piece of a near place's plane may be, in known ones
constexpr double kMostPromised = 1.02;  // what it may promise, likewise
constexpr double kLesser = 1e-7;        // by which a piece must be less to take the place of another
constexpr double kPairPromise = 4, kNearPromise = 1;  // DescentBound::promise

class Look {
 public:
  Look(const PieceInput& input, const Vec3& x, const LeastChord& known, const NearPlaces& near,
       const std::vector<LeastChord>& least, ChordDescent& descent)
      : in_(input), x_(x), known_(known), best_(known), near_(near), least_(least), descent_(descent) {}

  LeastChord run(const std::function<bool(std::uint32_t)>& heard) {
    list_saddles();
    for (std::size_t m = 0; m < count_; ++m) {
      for (std::size_t n = 0; n < m; ++n) {
        // A lesser piece leaves out a part that the known one has.
        if (saddles_[m].below || saddles_[n].below) try_pair(saddles_[m], saddles_[n]);
      }
    }
    near_.for_each([&](std::uint32_t q, const Vec3& way) {
      if (heard(q)) try_plane_of(least_[q], way);
    });
    return best_.erosion < known_.erosion ? descent_.look_across(x_, best_) : known_;
  }

 private:
  struct Saddle {
    std::uint32_t vertex;
    Vec3 from_x;
    bool below;  // the known plane
  };

  void add(std::uint32_t vertex) {
    if (vertex == LeastChord::kNone) return;
    const auto end = saddles_.begin() + static_cast<std::ptrdiff_t>(count_);
    if (std::any_of(saddles_.begin(), end, [&](const Saddle& s) { return s.vertex == vertex; })) return;
    const Vec3 from_x = in_.mesh.points[vertex] - x_;
    saddles_[count_++] = {vertex, from_x, dot(known_.normal, from_x) < -kTouchHeight};
  }

  void list_saddles() {
    for (const std::uint32_t s : known_.saddles) add(s);
    near_.for_each([&](std::uint32_t q, const Vec3&) {
      for (const std::uint32_t s : least_[q].saddles) add(s);
    });
    for (const SaddleSearch::Saddle& s : descent_.saddles().nearest(x_, kNearest)) add(s.vertex);
  }

  void try_pair(const Saddle& a, const Saddle& b) {
    const Vec3 across = cross(a.from_x, b.from_x);
    for (const double sign : {1.0, -1.0}) {
      LeastChord start;
      start.normal = sign * across;
      if (near_.holds_more(start.normal, best_.erosion)) continue;
      const double size = norm(across);
      if (!(size > 0)) return;
      start.normal = (1 / size) * start.normal;
      start.saddles = {std::min(a.vertex, b.vertex), std::max(a.vertex, b.vertex)};
      if (alike(start, best_) && start.saddles == best_.saddles) continue;
      if (!joins(a, start.normal) || !joins(b, start.normal)) continue;
      go_down(start, 1, kPairPromise);
    }
  }

  bool joins(const Saddle& saddle, const Vec3& d) {
    return descent_.saddles().may_join(x_, saddle.vertex, d);
  }

  void try_plane_of(const LeastChord& offer, const Vec3& way) {
    if (offer.kind() == 2) return;  // a pair
    if (alike(offer, best_) && offer.saddles == best_.saddles) return;
    if (promised(offer, -1 * way) > kMostPromised * best_.erosion) return;
    for (std::size_t n = 0; n < tries_; ++n) {
      if (tried_[n]->saddles == offer.saddles && alike(*tried_[n], offer)) return;
    }
    tried_[tries_++] = &offer;
    Vec3 d = offer.normal;
    if (offer.kind() == 1) {
      const Vec3 s = in_.mesh.points[offer.saddles[0]] - x_;
      d = d - (dot(d, s) / dot(s, s)) * s;
    }
    if (!near_.holds_more(d, best_.erosion)) go_down(offer, kNearFirst, kNearPromise);
  }

  void go_down(const LeastChord& start, double first, double promise) {
    const double less = best_.erosion * (1 - kLesser);
    const LeastChord found = descent_.descend(x_, start, {first * best_.erosion, less, promise});
    if (found.erosion < less) best_ = found;
  }

  const PieceInput& in_;
  const Vec3 x_;
  const LeastChord known_;
  LeastChord best_;
  const NearPlaces& near_;
  const std::vector<LeastChord>& least_;
  ChordDescent& descent_;
  std::array<Saddle, kMostSaddles> saddles_;
  std::size_t count_ = 0;
  std::array<const LeastChord*, NearPlaces::kMost> tried_;
  std::size_t tries_ = 0;
};

}  // namespace

LeastChord look_wider(const PieceInput& input, const Vec3& x, const LeastChord& known, const NearPlaces& near,
                      const std::vector<LeastChord>& least, const std::function<bool(std::uint32_t)>& heard,
                      ChordDescent& descent) {
  return Look(input, x, known, near, least, descent).run(heard);
}

}  // namespace affskel::core
