#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/none.h"
#include "core/erosion/directions.h"
#include "core/erosion/field.h"
#include "core/infimum/least_chord.h"
#include "core/infimum/near_places.h"
#include "core/infimum/piece_input.h"
#include "core/lattice/lattice.h"
#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {

/// Consecutive sample points [begin, end).
struct PointRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// What a round found at a point.
struct RefinedPoint {
  std::uint32_t point = 0;
  LeastChord least;
};

/// The rounds of refine(), each by ranges of points, which may be computed anywhere and in any order: what a
/// round finds at a point is a function of solid, lattice and what the round before left.
///
/// In round 0 those points whose indices along the axes are even go down from their seeds; the others wait with
/// theirs.  In rounds 1 to 3 points with one, two and three odd indices follow their neighbours, mostly with a
/// plane half-way between those of two: where the optimum turns steadily that is all but it, and where it does
/// not they go down from their own seeds, too.  A point without a neighbour to follow does not wait.  In the round
/// after that all points look wider (look_wider), and from then on those near which the round before changed
/// something.  Who has all that a round found puts it in with set(); the next round reads only that.
///
/// Threads: one calls, and descend() and improve() use those that were asked for.
class Refinement {
 public:
  /// The seed of a point: its value over a set of directions, scaled units.
  using Seeds = std::function<FieldValue(std::uint32_t point)>;

  /// `input` must outlive it.
  Refinement(const PieceInput& input, const Lattice& lattice, unsigned threads);

  std::uint32_t points() const { return static_cast<std::uint32_t>(least_.size()); }

  /// Round 0: every point of the range, ascending, those that wait with their seeds.  A point that lies outside
  /// within rounding keeps its seed.
  /// @throws CoreError kCancelled when the context asks to stop; so below.
  std::vector<RefinedPoint> descend(const DirectionSet& directions, const Seeds& seeds, PointRange range,
                                    ExecutionContext& context);

  /// Round `round` >= 1: those points of the range that find less than they have, and those whose first round
  /// it is, ascending.
  std::vector<RefinedPoint> improve(int round, PointRange range, ExecutionContext& context);

  /// Keeps what round `round` found.
  void set(const RefinedPoint& found, int round) {
    least_[found.point] = found.least;
    round_[found.point] = static_cast<std::uint8_t>(round);
  }

  const std::vector<LeastChord>& least() const { return least_; }
  std::vector<LeastChord> take() { return std::move(least_); }

 private:
  Vec3 at(std::uint32_t point) const;
  template <class Body>
  void each_of(std::size_t count, ExecutionContext& context, const Body& body);
  void find_first_rounds();
  bool has_begun(std::uint32_t neighbour, int round) const {
    return neighbour != kNone && first_[neighbour] < round;
  }
  bool is_news(std::uint32_t near_point, int round) const {
    return round == look_round_ || round_[near_point] + 1 == round;
  }
  bool has_news(std::uint32_t point, int round) const;
  struct Offer {
    LeastChord start;
    double promise = 0;  // E
  };
  std::size_t list_offers(int round, std::uint32_t point, std::array<Offer, 6>& offers) const;
  std::vector<std::uint32_t> to_do(int round, PointRange range) const;
  LeastChord from_seed(std::uint32_t point, const LeastChord& seed, ChordDescent& descent) const;
  LeastChord follow(int round, std::uint32_t point, ChordDescent& descent) const;
  LeastChord look(int round, std::uint32_t point, ChordDescent& descent) const;
  std::unique_ptr<ChordDescent> borrow();
  void give_back(std::unique_ptr<ChordDescent> descent);

  const PieceInput& input_;
  const LatticeGrid grid_;
  const unsigned threads_;
  std::vector<LatticePlace> places_;
  LatticeNeighbours around_;
  std::vector<LeastChord> least_;
  std::vector<std::uint8_t> round_;  // in which it was found
  std::vector<std::uint8_t> first_;  // round in which the point begins: 0 .. 3
  int look_round_ = 0;               // the one after the last of these
  std::mutex mutex_;
  std::vector<std::unique_ptr<ChordDescent>> idle_;  // guarded by mutex_
};

}  // namespace affskel::core
