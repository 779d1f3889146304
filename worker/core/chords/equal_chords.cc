// Notation.  The edge is p(t) = x + t delta, 0 <= t <= 1; a and b are the least pieces of its ends, followed to p(t):
// a(t), b(t) their volumes.  At x a is the lesser one, at y b is.  Where a(t) - b(t) changes its sign lies the shock:
// mostly it is 0 there; but a volume may jump past the other, where a part joins its piece.
#include "core/chords/equal_chords.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/base/matrix3.h"
#include "core/base/parallel.h"
#include "core/base/unit.h"
#include "core/chords/chord_edge.h"
#include "core/infimum/least_chord.h"
#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {
namespace {

constexpr std::size_t kBlock = 256;  // shocks that a thread takes at once
constexpr int kMaxSteps = 24;
constexpr int kMaxHalvings = 6;  // of the edge, in search of a place where both pieces are known
constexpr double kEqual = 1e-9;  // of the volume: how equal the two are
constexpr double kShort = 1e-9;  // of the edge: a stretch not worth halving
constexpr double kSame = 1e-6;   // 1 - cosine of two planes that are one

// The two pieces at a place of the edge.
struct Pair {
  double t = 0;
  LeastChord a, b;

  double difference() const { return a.erosion - b.erosion; }
  bool equal() const { return std::abs(difference()) <= kEqual * std::min(a.erosion, b.erosion); }
};

class EdgeOfShock {
 public:
  EdgeOfShock(const Lattice& lattice, const ChordShock& shock, ChordDescent& descent)
      : descent_(descent),
        start_(scaled_place(lattice, vector_of(shock.place))),
        way_(lattice.grid.axes[shock.axis]) {}

  // The pieces at the shock; none where there is but one.
  // @param a, b least pieces of the two ends.  @param t where to look first.
  std::optional<Pair> equal_pieces(LeastChord a, LeastChord b, double t) {
    std::optional<Pair> known;
    double low = 0, high = 1;
    int halvings = 0;
    for (int n = 0; n < kMaxSteps && high - low > kShort; ++n) {
      const std::optional<Pair> there = follow(a, b, t);
      if (!there) break;
      if (is_one(*there)) {
        if (++halvings > kMaxHalvings) break;
        const bool is_b = dot(there->a.normal, b.normal) > dot(there->a.normal, a.normal);
        (is_b ? high : low) = t;
        t = 0.5 * (low + high);
        continue;
      }
      known = there;
      if (there->equal()) break;
      a = there->a;
      b = there->b;
      (there->difference() < 0 ? low : high) = t;
      const double newton = t - there->difference() / (slope(a) - slope(b));
      t = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return known;
  }

 private:
  std::optional<Pair> follow(const LeastChord& a, const LeastChord& b, double t) {
    const Vec3 p = start_ + t * way_;
    Pair pair{t, descent_.descend(p, a), {}};
    if (!std::isfinite(pair.a.erosion)) return {};
    pair.b = descent_.descend(p, b);
    if (!std::isfinite(pair.b.erosion)) return {};
    return pair;
  }

  static bool is_one(const Pair& pair) {
    return pair.a.saddles == pair.b.saddles && dot(pair.a.normal, pair.b.normal) > 1 - kSame;
  }

  double slope(const LeastChord& piece) const { return piece.slope * dot(piece.normal, way_); }

  ChordDescent& descent_;
  const Vec3 start_, way_;
};

class Placing {
 public:
  Placing(const Solid& solid, const Lattice& lattice, const FrameField& field, const RefinedPieces& pieces)
      : lattice_(lattice),
        field_(field),
        pieces_(pieces),
        frame_(frame_matrix(lattice)),
        to_mesh_(inverse_transposed(frame_)),
        volume_(std::ldexp(1.0, 3 * solid.exponent)),
        area_(std::ldexp(1.0, 2 * solid.exponent)) {}

  void place(ChordShock& shock, ChordDescent& descent) const {
    EdgeOfShock edge(lattice_, shock, descent);
    const auto pair = edge.equal_pieces(least_of(shock.point), least_of(shock.upper), shock.t);
    shock.turns = !pair;
    if (!pair) return;
    shock.t = pair->t;
    shock.position = field_.spacing * (vector_of(shock.place) + shock.t * kIdentity3[shock.axis]);
    shock.erosion = volume_ * std::min(pair->a.erosion, pair->b.erosion);
    shock.gradient_low = gradient(pair->a);
    shock.gradient_high = gradient(pair->b);
  }

 private:
  LeastChord least_of(std::uint32_t point) const {
    LeastChord least;
    least.erosion = field_.erosion[point] / volume_;
    least.normal = unit(to_mesh_ * field_.gradient[point]);
    least.saddles = pieces_.saddles[point];
    return least;
  }

  Vec3 gradient(const LeastChord& piece) const {
    return area_ * piece.slope * transposed_times(frame_, piece.normal);
  }

  const Lattice& lattice_;
  const FrameField& field_;
  const RefinedPieces& pieces_;
  const Matrix3 frame_, to_mesh_;
  const double volume_, area_;  // mesh units cubed, squared, per scaled ones
};

}  // namespace

void place_at_equal_chords(const Solid& solid, const Lattice& lattice, const FrameField& field,
                           const RefinedPieces& pieces, std::vector<ChordShock>& shocks,
                           ExecutionContext* context) {
  const Placing placing(solid, lattice, field, pieces);
  parallel_for(pieces.threads, (shocks.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    ChordDescent descent(pieces.input);
    const std::size_t end = std::min(shocks.size(), (block + 1) * kBlock);
    for (std::size_t s = block * kBlock; s < end; ++s) {
      throw_if_stopped(context);
      placing.place(shocks[s], descent);
    }
  });
}

}  // namespace affskel::core
