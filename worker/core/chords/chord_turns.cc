// How turns are measured.
// 1. The shocks on a lattice line within q = (width d / h - 1) / 2 edges (rounded) of each other have one
//    peak: the one with the largest kink s (the first of equal ones), provided that it has the least
//    values.
// 2. The turn of a peak is the opening between the places q edges beyond both of its ends, but no further
//    than the line stays in the solid, and at least its own opening.  Between sample points normals are
//    interpolated.  All other shocks keep their own opening.
// 3. Then each peak takes the mean of its four cells' turns, at most twice its own; a cell has the mean of
//    its shocks, weighted by turn and area |N_a|.
//
// Why a band.  Finite direction sets, and noise all the more, break one jump of the normals into several
// small ones near each other.  Which of them is the widest changes with every perturbation, their sum does
// not.  So the one with the largest kink, the peak, takes the turn of the whole band (non-maximum
// suppression, as in Canny 1986).
//
// Why its width is a share of the depth.  Measured on bodies of 292, 1000 and 5000 triangles with 1 % vertex
// noise (of the diagonal), 8 seeds: shares of the skeletons within sqrt(3)/128 of the height, both ways.
//
//   0.7 of the depth      92.9 / 93.6 %
//   five spacings         94.2 / 93.6 %, but 51 tunnels for 22, and a third of the sheet is lost where the
//                         spacing is halved
//   the edge alone        91.0 / 89.1 %
//
// Halving the spacing (height / 90, 180, 360) moves what lies two coarse spacings from the rim by less than
// half a coarse spacing, but for one or two vertices.
#include "core/chords/chord_turns.h"

#include <algorithm>
#include <utility>

#include "core/base/none.h"
#include "core/base/unit.h"
#include "core/chords/chord_edge.h"
#include "core/contour/edge_cells.h"

namespace affskel::core {
namespace {

// Edges to either side of a peak's own.  A wider band belongs to a depth of 184 spacings, as in a body of a
// billion sample points, or to chords through a neck, whose volume is mostly far away.
constexpr double kMaxReach = 64;
// A mean may at most double a turn: edges that lie in a sheet, between two facets of one of its sides, have
// the sheet's own shocks round them.
constexpr double kMaxGain = 2;

class TurnGauge {
 public:
  TurnGauge(const Lattice& lattice, const FrameField& field, const EdgeCells& cells,
            std::vector<ChordShock>& shocks, ExecutionContext* context, const ChordConstants& constants)
      : lattice_(lattice),
        field_(field),
        cells_(cells),
        shocks_(shocks),
        context_(context),
        constants_(constants),
        is_peak_(shocks.size(), false) {}

  void measure() {
    reach_.reserve(shocks_.size());
    for (ChordShock& shock : shocks_) {
      shock.turn = shock.opening;
      reach_.push_back(reach_of(shock));
    }
    if (constants_.min_share > 0) find_largest_jumps();
    for (std::uint8_t axis = 0; axis < 3; ++axis) walk(axis);
  }

  void average() {
    std::vector<double> mean(cells_.size(), 0);
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
      double sum = 0, whole = 0;
      for (std::uint32_t s : cells_.edges[cell]) {
        const double share = squares_of(shocks_[s]) * shocks_[s].turn;
        sum += share * shocks_[s].turn;
        whole += share;
      }
      if (whole > 0) mean[cell] = sum / whole;
    }
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      if (!is_peak_[s]) continue;
      const auto& [a, b, c, d] = cells_.ring[s];
      const double along = 0.25 * ((mean[a] + mean[b]) + (mean[c] + mean[d]));
      shocks_[s].turn = std::min(along, kMaxGain * shocks_[s].turn);
    }
  }

 private:
  // q, in edges.
  double reach_of(const ChordShock& shock) const {
    const double area = 0.5 * length_of(shock.gradient_low) + 0.5 * length_of(shock.gradient_high);
    const double depth = shock.erosion / area / field_.spacing;
    return std::clamp(0.5 * (constants_.width * depth - 1), 0.0, kMaxReach);
  }

  std::uint32_t rounded_reach(std::uint32_t s) const { return static_cast<std::uint32_t>(reach_[s] + 0.5); }

  // Finds per shock the largest jump at most as many cells away as its band reaches.
  void find_largest_jumps() {
    std::vector<double> by_cell(cells_.size(), 0);
    std::uint32_t max_reach = 0;
    for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
      raise(by_cell, s, jump(s));
      max_reach = std::max(max_reach, rounded_reach(s));
    }
    largest_.resize(shocks_.size());
    for (std::uint32_t step = 0;; ++step) {
      throw_if_stopped(context_);
      for (std::uint32_t s = 0; s < shocks_.size(); ++s) {
        if (rounded_reach(s) >= step) largest_[s] = largest_round(by_cell, s);
      }
      if (step == max_reach) return;
      std::vector<double> wider = by_cell;
      for (std::uint32_t s = 0; s < shocks_.size(); ++s) raise(wider, s, largest_round(by_cell, s));
      by_cell = std::move(wider);
    }
  }

  void raise(std::vector<double>& by_cell, std::uint32_t s, double value) const {
    for (std::uint32_t cell : cells_.ring[s]) by_cell[cell] = std::max(by_cell[cell], value);
  }

  double largest_round(const std::vector<double>& by_cell, std::uint32_t s) const {
    const auto& [a, b, c, d] = cells_.ring[s];
    return std::max({by_cell[a], by_cell[b], by_cell[c], by_cell[d]});
  }

  double jump(std::uint32_t s) const { return length_of(shocks_[s].gradient_low - shocks_[s].gradient_high); }

  bool is_among_largest(std::uint32_t s) const {
    return largest_.empty() || jump(s) >= constants_.min_share * largest_[s];
  }

  // Measures along all stretches of an axis: a line of sample points, and the shock on each edge of it.
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
    if (s == kNone || shocks_[s].strength < constants_.min_peak_strength || !has_largest_kink(n) ||
        !is_concentrated(n) || !is_among_largest(s))
      return;
    is_peak_[s] = true;
    const auto whole = static_cast<std::uint32_t>(reach_[s]);
    const double rest = reach_[s] - whole;
    double turn = turn_over(n, whole);
    if (rest > 0) turn += rest * (turn_over(n, whole + 1) - turn);
    if (turn > shocks_[s].turn) shocks_[s].turn = turn;
  }

  // The gradients so many edges beyond the ends of the line's n-th edge.
  std::pair<const Vec3&, const Vec3&> ends_of_band(std::uint32_t n, std::uint32_t reach) const {
    const auto last = static_cast<std::uint32_t>(line_.size() - 1);
    return {field_.gradient[line_[n - std::min(n, reach)]],
            field_.gradient[line_[std::min(n + 1 + reach, last)]]};
  }

  double turn_over(std::uint32_t n, std::uint32_t reach) const {
    const auto& [low, high] = ends_of_band(n, reach);
    return opening_of(low, high);
  }

  bool is_concentrated(std::uint32_t n) const {
    const std::uint32_t s = on_line_[n];
    const int axis = shocks_[s].axis;
    const auto& [low, high] = ends_of_band(n, rounded_reach(s));
    return kink(s) >= constants_.min_concentration * (low[axis] - high[axis]);
  }

  bool has_largest_kink(std::uint32_t n) const {
    const double mine = kink(on_line_[n]);
    const std::uint32_t reach = rounded_reach(on_line_[n]);
    const auto end = std::min<std::size_t>(on_line_.size(), std::size_t{n} + reach + 1);
    for (std::size_t m = n - std::min(n, reach); m < end; ++m) {
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
  const EdgeCells& cells_;
  std::vector<ChordShock>& shocks_;
  ExecutionContext* context_;
  const ChordConstants& constants_;
  std::vector<bool> is_peak_;                  // per shock
  std::vector<double> reach_;                  // per shock: q
  std::vector<double> largest_;                // per shock, see find_largest_jumps; or empty
  std::vector<std::uint32_t> line_, on_line_;  // of one stretch
};

}  // namespace

void measure_turns(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                   std::vector<ChordShock>& shocks, ExecutionContext* context,
                   const ChordConstants& constants) {
  const EdgeCells cells = cells_of(lattice, parts, shocks);
  TurnGauge gauge(lattice, field, cells, shocks, context, constants);
  gauge.measure();
  for (std::uint32_t round = 0; round < constants.rounds; ++round) gauge.average();
}

}  // namespace affskel::core
