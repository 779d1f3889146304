#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/bucket_queue.h"
#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// Elementary collapses of a complex, in an order.  A cell is free when it has exactly one coface; a free cell
/// and its coface are removed together, which keeps the homotopy type (Whitehead 1939).  What collapse() and
/// thinned_solid() with limb_tips() share.
class Collapsing {
 public:
  using Cell = DualComplex::Cell;

  /// Times are told apart by this much.
  static constexpr double kStep = 0.125;

  /// When a pair is removed, >= 0, and a mark of its that removed() is told.
  struct Due {
    double time = 0;
    bool mark = false;
  };

  /// Of all cells of a complex.
  /// @throws CoreError kCancelled, here and in run(), when the context asks to stop.
  Collapsing(const DualComplex& complex, ExecutionContext* context)
      : complex_(complex), context_(context), states_(complex, DualComplex::kAllPlaces, 0) {
    StopCheck stop(context);
    states_.for_each([&](Cell cell, std::uint8_t& state) {
      state = static_cast<std::uint8_t>(kThere | complex.coface_count(cell));
      stop.did(20);
    });
  }

  /// Of some, closed under taking boundaries.
  Collapsing(const DualComplex& complex, const CellSet& cells, ExecutionContext* context)
      : complex_(complex), context_(context), states_(complex, DualComplex::kAllPlaces, 0) {
    cells.for_each([&](Cell cell) {
      state(cell) |= kThere;
      complex_.for_each_face(cell, [&](Cell face) { ++state(face); });
    });
  }

  bool has(Cell cell) const { return (state(cell) & kThere) != 0; }

  /// A cell may not be removed, nor its boundary.
  void fix(Cell cell) {
    if ((state(cell) & kFixed) != 0) return;
    state(cell) |= kFixed;
    complex_.for_each_face(cell, [&](Cell face) { fix(face); });
  }
  /// It may again; its boundary may not.
  void release(Cell cell) { state(cell) &= static_cast<std::uint8_t>(~kFixed); }
  bool is_fixed(Cell cell) const { return (state(cell) & kFixed) != 0; }

  /// Whether a cell may be removed and has exactly one coface.
  bool is_free(Cell cell) const { return state(cell) == kFree; }

  /// How many cofaces a cell has.
  std::uint32_t cofaces(Cell cell) const { return state(cell) & kCount; }

  CellSet cells() {
    CellSet result(complex_);
    states_.for_each([&](Cell cell, std::uint8_t state) {
      if ((state & kThere) != 0) result.insert(cell);
    });
    return result;
  }

  /// Collapses as far as it goes, beginning with what is free now.
  /// @param rules  due(cell, coface, now): when a pair that became free at `now` is removed; pairs leave by time,
  ///   those of one time in waves, each what the one before has freed, and of cells with one coface the first by
  ///   level(cell) and CellRank, so that with levels that know no order of axes a mirror image is collapsed to the
  ///   mirror image;
  ///   removed(cell, coface, now, mark of the pair), in a wave in any order.  May have wave_ends(), stays(cell): whether
  ///   it is not removed with a coface, lost_coface(cell, how many are left, now), and next_cut(): after a wave a cell
  ///   without cofaces that is taken out by itself, or nothing.
  template <class Rules>
  void run(Rules& rules) {
    states_.for_each([&](Cell cell, std::uint8_t state) {
      if (state == kFree) offer(cell, 0, rules);
    });
    go_on(rules);
  }

  /// The same where no others are there.
  template <class Rules>
  void run(Rules& rules, const CellSet& cells) {
    cells.for_each([&](Cell cell) {
      if (is_free(cell)) offer(cell, 0, rules);
    });
    go_on(rules);
  }

  /// Goes on with a cell that was released.
  template <class Rules>
  void run_from(Cell cell, Rules& rules) {
    if (is_free(cell)) offer(cell, static_cast<double>(queue_.current()) * kStep, rules);
    go_on(rules);
  }

 private:
  static constexpr std::uint8_t kThere = 0x80, kFixed = 0x40, kCount = 0x1F, kFree = kThere | 1;

  std::uint8_t& state(Cell cell) { return states_[cell]; }
  std::uint8_t state(Cell cell) const { return states_[cell]; }

  // A coface, which of its sides is the free cell, and the rules' mark: one number, since the queue is the largest array of
  // a collapse.
  using Pair = std::uint64_t;
  static Pair pair_of(Cell coface, std::uint32_t side, bool mark) {
    return coface << 4 | side << 1 | (mark ? 1U : 0U);
  }
  static Cell coface_of(Pair pair) { return pair >> 4; }
  Cell cell_of(Pair pair) const {
    return complex_.face(coface_of(pair), static_cast<std::uint32_t>(pair >> 1 & 7));
  }
  static bool mark_of(Pair pair) { return (pair & 1) != 0; }

  // A cell that is free.
  template <class Rules>
  void offer(Cell cell, double now, Rules& rules) {
    if constexpr (requires { rules.stays(cell); })
      if (rules.stays(cell)) return;
    complex_.any_coface(cell, [&](Cell coface, std::uint32_t side) {  // not fixed, else the cell would be
      if (!has(coface)) return false;
      const Due due = rules.due(cell, coface, now);
      queue_.push(static_cast<std::size_t>(due.time / kStep), pair_of(coface, side, due.mark));
      return true;
    });
  }

  // Two pairs of a wave are in each other's way only if they have the coface in common: between a cell and one of two
  // dimensions more there are two, so that the coface of a free cell is not free.  Nothing else needs an order; sorted, these
  // are beside each other, and cells are met as they lie in memory.  What is free of a wave at first is when its turn comes: a
  // free cell stays so as long as its coface is there.
  template <class Rules>
  void go_on(Rules& rules) {
    StopCheck stop(context_);
    std::vector<Pair> wave;
    while (queue_.pop_wave(wave)) {
      const double now = static_cast<double>(queue_.current()) * kStep;
      stop.did(10 * wave.size());
      std::sort(wave.begin(), wave.end());
      for (auto first = wave.begin(), last = first; first != wave.end(); first = last) {
        const Cell coface = coface_of(*first);
        while (last != wave.end() && coface_of(*last) == coface) ++last;
        if (!has(coface)) continue;
        stop.did(100);
        remove(last - first == 1 ? *first : lowest({first, last}, rules), now, rules);
      }
      if constexpr (requires { rules.wave_ends(); }) rules.wave_ends();
      if constexpr (requires { rules.next_cut(); }) take_cuts(now, rules);
    }
  }

  template <class Rules>
  Pair lowest(std::span<const Pair> rivals, const Rules& rules) const {
    const auto rank = [&](Pair pair) {
      return CellRank(complex_, rules.level(cell_of(pair)), cell_of(pair));
    };
    return *std::min_element(rivals.begin(), rivals.end(), [&](Pair a, Pair b) { return rank(a) < rank(b); });
  }

  template <class Rules>
  void remove(Pair pair, double now, Rules& rules) {
    const Cell cell = cell_of(pair), coface = coface_of(pair);
    state(cell) = state(coface) = 0;
    rules.removed(cell, coface, now, mark_of(pair));
    complex_.for_each_face(coface, [&](Cell face) {
      if (face != cell) lose_coface(face, now, rules);
    });
    complex_.for_each_face(cell, [&](Cell face) { lose_coface(face, now, rules); });
  }

  template <class Rules>
  void take_cuts(double now, Rules& rules) {
    while (const auto cut = rules.next_cut()) {
      if (!has(*cut)) continue;
      state(*cut) = 0;
      complex_.for_each_face(*cut, [&](Cell face) { lose_coface(face, now, rules); });
    }
  }

  template <class Rules>
  void lose_coface(Cell cell, double now, Rules& rules) {
    const std::uint8_t left = --state(cell);
    if constexpr (requires { rules.lost_coface(cell, 0U, now); })
      if ((left & kThere) != 0) rules.lost_coface(cell, left & kCount, now);
    if (left == kFree) offer(cell, now, rules);
  }

  const DualComplex& complex_;
  ExecutionContext* context_;
  CellValues<std::uint8_t> states_;  // at own names: these, and how many cofaces
  BucketQueue<Pair> queue_;          // free when they came
};

}  // namespace affskel::core
