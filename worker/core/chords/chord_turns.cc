#include "core/chords/chord_turns.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/near_one.h"
#include "core/base/require.h"
#include "core/chords/chord_cells.h"
#include "core/chords/chord_edge.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;
constexpr std::uint32_t kMost = 16;
// What a mean may make of a turn: twice as much.  Edges that lie in a sheet, between two facets of one of its
// sides, have the sheet's own shocks round them.
constexpr double kMostGain = 2;

class TurnGauge {
 public:
  TurnGauge(const Lattice& lattice, const FrameField& field, const ChordCells& cells,
            std::vector<ChordShock>& shocks, const ChordTurnOptions& options)
      : lattice_(lattice),
        field_(field),
        cells_(cells),
        shocks_(shocks),
        reach_(options.reach),
        least_share_(options.least_share),
        speaks_(shocks.size(), false) {}

  void measure() {
    for (ChordShock& shock : shocks_) shock.turn = shock.opening;
    find_largest_jumps();
    for (std::uint8_t axis = 0; axis < 3; ++axis) walk(axis);
  }

  void average() {
    std::vector<double> mean(cells_.size(), 0);
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
      double sum = 0, whole = 0;
      for (std::uint32_t s : cells_.shocks_of(cell)) {
        const double share = squares_of(shocks_[s]) * shocks_[s].turn;
        sum += share * shocks_[s].turn;
        whole += share;
      }
      if (whole > 0) mean[cell] = sum / whole;
    }
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (!speaks_[s]) continue;
      const auto& [a, b, c, d] = cells_.ring[s];
      const double along = 0.25 * ((mean[a] + mean[b]) + (mean[c] + mean[d]));
      shocks_[s].turn = std::min(along, kMostGain * shocks_[s].turn);
    }
  }

 private:
  // Per cell: the largest jump at most `reach` cells away.
  void find_largest_jumps() {
    largest_.assign(cells_.size(), 0);
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) raise(largest_, s, jump(s));
    for (std::uint32_t step = 0; step < reach_; ++step) {
      std::vector<double> wider = largest_;
      for (std::uint32_t s = 0; s < shocks_.size(); ++s) raise(wider, s, largest_at(s));
      largest_ = std::move(wider);
    }
  }

  void raise(std::vector<double>& by_cell, std::uint32_t s, double value) const {
    for (std::uint32_t cell : cells_.ring[s]) by_cell[cell] = std::max(by_cell[cell], value);
  }

  double largest_at(std::uint32_t s) const {
    const auto& [a, b, c, d] = cells_.ring[s];
    return std::max({largest_[a], largest_[b], largest_[c], largest_[d]});
  }

  double jump(std::uint32_t s) const {
    const Vec3 difference = shocks_[s].gradient_low - shocks_[s].gradient_high;
    return std::ldexp(norm(near_one(difference)), largest_exponent(difference));
  }

  bool is_among_largest(std::uint32_t s) const { return jump(s) >= least_share_ * largest_at(s); }

  // A line of sample points in the solid, and the shock on each edge from one to the next.
  void walk(std::uint8_t axis) {
    const AxisRuns& along = lattice_.axis[axis];
    std::vector<std::uint32_t> shock_from(lattice_.points, kNone);
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (shocks_[s].axis == axis) shock_from[shocks_[s].point] = s;
    }
    for_each_stretch(along, axis, [&](const LatticeRun& run) {
      line_.clear();
      on_line_.clear();
      for (std::uint32_t n = run.first; n < run.first + run.length; ++n) {
        line_.push_back(along.order.empty() ? n : along.order[n]);
        on_line_.push_back(shock_from[line_.back()]);
      }
      for (std::uint32_t n = 0; n + 1 < run.length; ++n) gauge(n);
    });
  }

  void gauge(std::uint32_t n) {
    const std::uint32_t s = on_line_[n];
    if (s == kNone || !is_greatest(n) || !is_among_largest(s)) return;
    speaks_[s] = true;
    const auto last = static_cast<std::uint32_t>(line_.size() - 1);
    const std::uint32_t x = line_[n - std::min(n, reach_)], y = line_[std::min(n + 1 + reach_, last)];
    const double turn = opening_of(field_.gradient[x], field_.gradient[y]);
    if (turn > shocks_[s].turn) shocks_[s].turn = turn;
  }

  bool is_greatest(std::uint32_t n) const {
    const double mine = kink(on_line_[n]);
    const auto end = std::min<std::size_t>(on_line_.size(), std::size_t{n} + reach_ + 1);
    for (std::size_t m = n - std::min(n, reach_); m < end; ++m) {
      if (m == n || on_line_[m] == kNone) continue;
      const double other = kink(on_line_[m]);
      if (m < n ? other >= mine : other > mine) return false;
    }
    return true;
  }

  // s / |delta|; all edges have the same length.
  double kink(std::uint32_t s) const {
    const ChordShock& shock = shocks_[s];
    return shock.gradient_low[shock.axis] - shock.gradient_high[shock.axis];
  }

  const Lattice& lattice_;
  const FrameField& field_;
  const ChordCells& cells_;
  std::vector<ChordShock>& shocks_;
  std::uint32_t reach_;
  double least_share_;
  std::vector<bool> speaks_;                   // per shock: for those round it
  std::vector<double> largest_;                // per cell, see find_largest_jumps
  std::vector<std::uint32_t> line_, on_line_;  // of one stretch
};

}  // namespace

void measure_turns(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                   std::vector<ChordShock>& shocks, const ChordTurnOptions& options) {
  if (options.reach > kMost || options.rounds > kMost) {
    throw CoreError(CoreError::Code::kBadInput, "reach and rounds of the turns must lie between 0 and 16");
  }
  require_within(options.least_share, 0, 1, "the least share of the jump must lie between 0 and 1");
  const ChordCells cells = chord_cells(lattice, parts, shocks);
  TurnGauge gauge(lattice, field, cells, shocks, options);
  gauge.measure();
  for (std::uint32_t round = 0; round < options.rounds; ++round) gauge.average();
}

}  // namespace affskel::core
