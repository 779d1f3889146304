#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/bucket_queue.h"
#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// Elementary collapses of a complex, in an order.  A cell is free when it has exactly one coface; a free cell
/// and its coface are removed together, which keeps the homotopy type (Whitehead 1939).  What collapse() and
/// limb_tips() share.
class Collapsing {
 public:
  using Cell = DualComplex::Cell;

  /// Times are told apart by this much.
  static constexpr double kStep = 0.125;

  /// Of all cells of a complex.
  /// @throws CoreError kCancelled, here and in run(), when the context asks to stop.
  Collapsing(const DualComplex& complex, ExecutionContext* context)
      : complex_(complex), context_(context), states_(complex) {
    StopCheck stop(context);
    complex.for_each_cell([&](Cell cell) {
      state(cell) = static_cast<std::uint8_t>(kThere | complex.cofaces(cell).count);
      stop.did(20);
    });
  }

  /// Of some, closed under taking boundaries.
  Collapsing(const DualComplex& complex, const CellSet& cells, ExecutionContext* context)
      : complex_(complex), context_(context), states_(complex) {
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
  bool is_free(Cell cell) const { return state(cell) == (kThere | 1); }

  /// How many cofaces a cell has.
  std::uint32_t cofaces(Cell cell) const { return state(cell) & static_cast<std::uint8_t>(kClaimed - 1); }

  CellSet cells() const {
    CellSet result(complex_);
    for_each_name([&](Cell cell) {
      if (has(cell)) result.insert(cell);
    });
    return result;
  }

  /// Collapses as far as it goes, beginning with what is free now.
  /// @param rules  time(cell, coface, now): when a pair that became free at `now` is removed, >= 0; pairs leave by time,
  ///   those of one time in waves, each what the one before has freed, and of cells with one coface the first by
  ///   level(cell) and rank_of(), so that with levels that know no order of axes a mirror image is collapsed to the
  ///   mirror image;
  ///   removed(cell, coface, now), in a wave in any order; bared(cell, now): the last coface of a cell that stays was
  ///   removed.  May have wave_ends(), and next_cut(): after a wave a cell without cofaces that is taken out by
  ///   itself, or nothing.
  template <class Rules>
  void run(Rules& rules) {
    for_each_name([&](Cell cell) { offer(cell, 0, rules); });
    go_on(rules);
  }

  /// Goes on with a cell that was released.
  template <class Rules>
  void run_from(Cell cell, Rules& rules) {
    offer(cell, static_cast<double>(queue_.current()) * kStep, rules);
    go_on(rules);
  }

 private:
  static constexpr std::uint8_t kThere = 0x80, kFixed = 0x40, kClaimed = 0x20;

  std::uint8_t& state(Cell cell) { return states_[cell]; }
  std::uint8_t state(Cell cell) const { return states_[cell]; }

  template <class Visit>
  void for_each_name(const Visit& visit) const {
    for (std::uint32_t cube = 0; cube < complex_.cubes(); ++cube)
      for (std::uint32_t place = 0; place < 27; ++place)
        if (states_.may_own(cube, place)) visit(DualComplex::name(cube, place));
  }

  // The first that is there.
  Cell coface_of(Cell cell) const {
    Cell found = cell;
    complex_.any_coface(cell, [&](Cell coface) {
      if (has(coface)) found = coface;
      return found == coface;
    });
    return found;
  }

  template <class Rules>
  void offer(Cell cell, double now, Rules& rules) {
    if (!is_free(cell)) return;
    const Cell coface = coface_of(cell);  // not fixed, else the cell would be
    queue_.push(static_cast<std::size_t>(rules.time(cell, coface, now) / kStep), cell);
  }

  // Two pairs of a wave are in each other's way only if they have the coface in common: between a cell and one of two
  // dimensions more there are two, so that the coface of a free cell is not free.  Nothing else needs an order.  Cofaces
  // are found again, not kept: the queue is the largest array of a collapse.  What is free of a wave at first is when
  // its turn comes.
  template <class Rules>
  void go_on(Rules& rules) {
    StopCheck stop(context_);
    std::vector<Cell> contested;
    std::vector<std::pair<Cell, Cell>> rivals;  // coface first
    while (queue_.pop_wave()) {
      const double now = static_cast<double>(queue_.current()) * kStep;
      contested.clear();
      queue_.for_each_in_wave([&](Cell cell) {
        if (!is_free(cell)) return;
        const Cell coface = coface_of(cell);
        if ((state(coface) & kClaimed) != 0) contested.push_back(coface);
        state(coface) |= kClaimed;
      });
      for (const Cell coface : contested) state(coface) &= static_cast<std::uint8_t>(~kClaimed);
      rivals.clear();
      queue_.for_each_in_wave([&](Cell cell) {
        if (!is_free(cell)) return;
        stop.did(100);
        const Cell coface = coface_of(cell);
        if ((state(coface) & kClaimed) != 0)
          remove(cell, coface, now, rules);
        else
          rivals.emplace_back(coface, cell);
      });
      std::sort(rivals.begin(), rivals.end());
      for (auto first = rivals.begin(), last = first; first != rivals.end(); first = last) {
        const auto rank = [&](Cell cell) { return rank_of(complex_, rules.level(cell), cell); };
        CellRank lowest = rank(first->second);
        for (last = first + 1; last != rivals.end() && last->first == first->first; ++last)
          lowest = std::min(lowest, rank(last->second));
        remove(lowest.cell, first->first, now, rules);
      }
      if constexpr (requires { rules.wave_ends(); }) rules.wave_ends();
      if constexpr (requires { rules.next_cut(); }) take_cuts(now, rules);
    }
  }

  template <class Rules>
  void remove(Cell cell, Cell coface, double now, Rules& rules) {
    state(cell) = state(coface) = 0;
    rules.removed(cell, coface, now);
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
    if (((--state(cell)) & ~kFixed) == kThere) rules.bared(cell, now);
    offer(cell, now, rules);
  }

  const DualComplex& complex_;
  ExecutionContext* context_;
  CellBytes states_;         // at own names: these, and how many cofaces
  BucketQueue<Cell> queue_;  // free when they came
};

}  // namespace affskel::core
