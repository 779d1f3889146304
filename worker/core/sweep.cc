// Notation.  A pass handles one direction d.  Along the chosen axis the points of a run have heights
// h = ((d0 + i s0) + j s1) + k s2, always computed like that, so that a chord is a function of the point
// and not of the way the sweep came to it.  "Upward" means the way heights grow along the axis.
#include "core/sweep.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace affskel::core {
namespace {

constexpr std::uint32_t kSegment = 8;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double load(const double& shared) {
  return std::atomic_ref<double>(const_cast<double&>(shared)).load(std::memory_order_relaxed);
}
void store(double& shared, double value) {
  std::atomic_ref<double>(shared).store(value, std::memory_order_relaxed);
}

}  // namespace

class Sweeper::Pass {
 public:
  Pass(Sweeper& owner, const JoinTree& tree, const Vec3& d, std::uint32_t index)
      : owner_(owner), tree_(tree), index_(index) {
    const LatticeFrame& frame = owner.lattice_.frame;
    base_ = dot(d, frame.origin);
    for (std::size_t k = 0; k < 3; ++k) step_[k] = dot(d, frame.axes[k]);
  }

  SweepCounts run() {
    const std::size_t a = choose_axis();
    const AxisRuns& axis = owner_.lattice_.axis[a];
    if (owner_.options_.prune) {
      for (std::size_t r = 0; r < axis.runs.size(); ++r) pruned_run(a, r);
    } else {
      for (const LatticeRun& run : axis.runs) whole_run(a, run);
    }
    for (const LatticeRun& stray : axis.strays) whole_run(2, stray);
    return counts_;
  }

 private:
  // Where the last chord was found: the next one along the run is on the same arc or above.
  struct Cursor {
    std::uint32_t arc;
    double volume = 0;
    const Piece* piece = nullptr;
  };

  std::size_t choose_axis() const {
    std::size_t best = 0;
    double best_slope = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double slope = std::abs(step_[k]) / norm(owner_.lattice_.frame.axes[k]);
      if (slope > best_slope) {
        best = k;
        best_slope = slope;
      }
    }
    return best;
  }

  // Height of the point `offset` points above the run's first.
  double height(std::size_t a, const LatticeRun& run, std::uint32_t offset) const {
    std::array<std::uint32_t, 3> at = run.start;
    at[a] += offset;
    return ((base_ + at[0] * step_[0]) + at[1] * step_[1]) + at[2] * step_[2];
  }

  // Offset of the n-th point upward.
  static std::uint32_t upward(const LatticeRun& run, bool rising, std::uint32_t n) {
    return rising ? n : run.length - 1 - n;
  }

  std::uint32_t point(std::size_t a, const LatticeRun& run, std::uint32_t offset) const {
    const std::vector<std::uint32_t>& order = owner_.lattice_.axis[a].order;
    return order.empty() ? run.first + offset : order[run.first + offset];
  }

  void find(Cursor& cursor, double h) const {
    while (h >= tree_.arcs[cursor.arc].top) cursor.arc = tree_.arcs[cursor.arc].parent;
    cursor.piece = &tree_.locate(tree_.arcs[cursor.arc], h);
    const double volume = cursor.piece->volume_at(h);
    // Rounding may leave a little less than nothing; much less only happens where a mesh crosses itself,
    // and says nothing about the chord there.
    cursor.volume = volume > 0 ? volume : volume >= -owner_.options_.margin ? 0 : kInfinity;
  }

  void offer(std::uint32_t p, const Cursor& cursor, double h) {
    if (!owner_.field_.may_improve(p, cursor.volume) || cursor.volume == kInfinity) return;
    const double area = cursor.piece->area_at(h);
    owner_.field_.offer(p, {cursor.volume, area > 0 ? area : 0, index_});
  }

  void whole_run(std::size_t a, const LatticeRun& run) {
    const bool rising = step_[a] >= 0;
    Cursor cursor{tree_.triangle_arc[rising ? run.low : run.high]};
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const std::uint32_t offset = upward(run, rising, n);
      const double h = height(a, run, offset);
      find(cursor, h);
      offer(point(a, run, offset), cursor, h);
    }
    counts_.evaluated += run.length;
  }

  void pruned_run(std::size_t a, std::size_t r) {
    const LatticeRun& run = owner_.lattice_.axis[a].runs[r];
    AxisBounds& bounds = owner_.bounds_[a];
    const double bound = load(bounds.run[r]);
    const bool rising = step_[a] >= 0;
    Cursor cursor{tree_.triangle_arc[rising ? run.low : run.high]};
    find(cursor, height(a, run, upward(run, rising, 0)));
    ++counts_.tested;
    if (cursor.volume > bound + owner_.options_.margin) return;
    const std::uint32_t segments = (run.length + kSegment - 1) / kSegment;
    double* segment = &bounds.segment[bounds.first_segment[r]];
    double largest = 0;
    for (std::uint32_t n = 0; n < segments; ++n) {
      const std::uint32_t s = rising ? n : segments - 1 - n;
      if (!(cursor.volume > bound + owner_.options_.margin))
        pruned_segment(a, run, rising, s, cursor, segment[s]);
      largest = std::max(largest, load(segment[s]));
    }
    store(bounds.run[r], largest);
  }

  // Segment s holds the points of offsets [s kSegment, (s + 1) kSegment).
  void pruned_segment(std::size_t a, const LatticeRun& run, bool rising, std::uint32_t s, Cursor& cursor,
                      double& bound) {
    const std::uint32_t begin = s * kSegment, end = std::min(begin + kSegment, run.length);
    const auto nth = [&](std::uint32_t n) { return rising ? begin + n : end - 1 - n; };
    double h = height(a, run, nth(0));
    find(cursor, h);
    ++counts_.tested;
    if (cursor.volume > load(bound) + owner_.options_.margin) return;
    double largest = 0;
    for (std::uint32_t o = begin; o < end; ++o)
      largest = std::max(largest, owner_.field_.erosion(point(a, run, o)));
    store(bound, largest);
    if (cursor.volume > largest + owner_.options_.margin) return;
    largest = 0;
    for (std::uint32_t n = 0; n < end - begin; ++n) {
      const std::uint32_t p = point(a, run, nth(n));
      if (n > 0) {
        h = height(a, run, nth(n));
        find(cursor, h);
      }
      offer(p, cursor, h);
      largest = std::max(largest, std::min(owner_.field_.erosion(p), cursor.volume));
    }
    counts_.evaluated += end - begin;
    store(bound, largest);
  }

  Sweeper& owner_;
  const JoinTree& tree_;
  std::uint32_t index_;
  double base_ = 0;
  std::array<double, 3> step_{};
  SweepCounts counts_;
};

Sweeper::Sweeper(const Lattice& lattice, ErosionField& field, const SweepOptions& options)
    : lattice_(lattice), field_(field), options_(options) {
  if (!options.prune) return;
  for (std::size_t a = 0; a < 3; ++a) {
    AxisBounds& bounds = bounds_[a];
    std::uint32_t segments = 0;
    for (const LatticeRun& run : lattice.axis[a].runs) {
      bounds.first_segment.push_back(segments);
      segments += (run.length + kSegment - 1) / kSegment;
    }
    bounds.run.assign(lattice.axis[a].runs.size(), kInfinity);
    bounds.segment.assign(segments, kInfinity);
  }
}

SweepCounts Sweeper::sweep(const JoinTree& tree, const Vec3& d, std::uint32_t index) {
  return Pass(*this, tree, d, index).run();
}

}  // namespace affskel::core
