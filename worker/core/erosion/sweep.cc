// Notation.  A pass handles one direction d.  Along the chosen axis the points of a run have heights
// h = ((d0 + i s0) + j s1) + k s2, always computed like that, so that a chord is a function of the point
// and not of the way the sweep came to it.  "Upward" means the way heights grow along the axis.
#include "core/erosion/sweep.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace affskel::core {
namespace {

constexpr std::uint32_t kSegment = 8;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

double load(const double& shared) {
  return std::atomic_ref<double>(const_cast<double&>(shared)).load(std::memory_order_relaxed);
}
void store(double& shared, double value) {
  std::atomic_ref<double>(shared).store(value, std::memory_order_relaxed);
}

// A chord with 36 significant bits.  Where a solid is its own mirror image, two directions have chords that
// are equal but for the last bits.  Unrounded, the lesser of the two, and with it the normal, would change
// from point to point.  Never changes the order of two chords.
double rounded(double volume) {
  constexpr int kDropped = 17;
  const auto bits = std::bit_cast<std::uint64_t>(volume) + (std::uint64_t{1} << (kDropped - 1));
  return std::bit_cast<double>(bits >> kDropped << kDropped);
}

}  // namespace

class Sweeper::Pass {
 public:
  Pass(Sweeper& owner, const JoinTree& tree, const Vec3& d, std::uint32_t index)
      : owner_(owner), tree_(tree), index_(index) {
    const LatticeGrid& grid = owner.lattice_.grid;
    base_ = dot(d, grid.origin);
    for (std::size_t k = 0; k < 3; ++k) step_[k] = dot(d, grid.axes[k]);
  }

  SweepCounts run() {
    const std::size_t a = choose_axis();
    const AxisRuns& axis = owner_.lattice_.axis[a];
    if (owner_.options_.prune) {
      step_[a] >= 0 ? pruned_runs<true>(a) : pruned_runs<false>(a);
    } else {
      for (const LatticeRun& run : axis.runs) whole_run(a, run);
    }
    for (const LatticeRun& stray : axis.strays) whole_run(2, stray);
    return counts_;
  }

 private:
  // The axis nearest to level: V hardly changes along its runs, so that one test decides for many points.
  std::size_t choose_axis() const {
    std::size_t best = 0;
    double best_slope = kUnbounded;
    for (std::size_t k = 0; k < 3; ++k) {
      const double slope = std::abs(step_[k]) / norm(owner_.lattice_.grid.axes[k]);
      if (slope < best_slope) {
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

  std::uint32_t point(std::size_t a, const LatticeRun& run, std::uint32_t offset) const {
    return a == 2 ? run.first + offset : owner_.lattice_.axis[a].order[run.first + offset];
  }

  // The arc of the component at the run's lowest point, or an arc below it.
  const Arc* first_arc(const LatticeRun& run, bool rising) const {
    return &tree_.arcs[tree_.triangle_arc[rising ? run.low : run.high]];
  }

  void climb(const Arc*& arc, double h) const {
    while (h >= arc->top) arc = &tree_.arcs[arc->parent];
  }

  // Whether the chords of all points of the run from height h upward exceed `bound`.
  bool exceeds(const Arc& arc, double h, double bound) const {
    return tree_.volume_below(arc, h) > bound + owner_.options_.margin;
  }

  void evaluate(std::uint32_t p, const Arc& arc, double h) {
    ++counts_.evaluated;
    const Cubic& cubic = tree_.locate(arc, h);
    double volume = cubic.volume_at(h);
    // Rounding may give a small negative volume.
    if (volume < 0) volume = volume < -owner_.options_.margin ? owner_.options_.solid_volume : 0;
    volume = rounded(volume);
    if (!owner_.field_.may_improve(p, volume)) return;
    const double area = cubic.area_at(h);
    owner_.field_.offer(p, {volume, area > 0 ? area : 0, index_});
  }

  void whole_run(std::size_t a, const LatticeRun& run) {
    const bool rising = step_[a] >= 0;
    const Arc* arc = first_arc(run, rising);
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const std::uint32_t offset = rising ? n : run.length - 1 - n;
      const double h = height(a, run, offset);
      climb(arc, h);
      evaluate(point(a, run, offset), *arc, h);
    }
  }

  template <bool rising>
  void pruned_runs(std::size_t a) {
    if (a == 0) return pruned_runs<0, rising>();
    return a == 1 ? pruned_runs<1, rising>() : pruned_runs<2, rising>();
  }

  // Heights of a run's points, equal to those of height(); computes what they share once.
  template <std::size_t a>
  class RunHeights {
   public:
    RunHeights(const Pass& pass, const LatticeRun& run) : step_(pass.step_[a]), start_(run.start[a]) {
      const double i = run.start[0] * pass.step_[0], j = run.start[1] * pass.step_[1];
      before_ = a == 0 ? pass.base_ : a == 1 ? pass.base_ + i : (pass.base_ + i) + j;
      if (a == 0) next_ = j;
      if (a != 2) last_ = run.start[2] * pass.step_[2];
    }

    double at(std::uint32_t offset) const {
      const double h = before_ + (start_ + offset) * step_;
      return a == 0 ? (h + next_) + last_ : a == 1 ? h + last_ : h;
    }

   private:
    double step_, before_, next_ = 0, last_ = 0;
    std::uint32_t start_;
  };

  // The processor cannot predict how a test ends, and a wrong guess costs more than the test.  So candidates
  // are listed without a branch, here and in pruned_segment(), and evaluated afterwards.
  template <std::size_t a, bool rising>
  void pruned_runs() {
    const std::vector<LatticeRun>& runs = owner_.lattice_.axis[a].runs;
    const AxisBounds& bounds = owner_.bounds_[a];
    counts_.tested += runs.size();
    struct Passed {
      std::size_t run;
      const Arc* arc;
      double bound;
    };
    std::array<Passed, 64> passed;
    for (std::size_t begin = 0; begin < runs.size(); begin += passed.size()) {
      std::size_t count = 0;
      for (std::size_t r = begin; r < std::min(begin + passed.size(), runs.size()); ++r) {
        const LatticeRun& run = runs[r];
        const Arc* arc = first_arc(run, rising);
        const double h = RunHeights<a>(*this, run).at(rising ? 0 : run.length - 1);
        climb(arc, h);
        const double bound = load(bounds.run[r]);
        passed[count] = {r, arc, bound};
        count += exceeds(*arc, h, bound) ? 0 : 1;
      }
      for (std::size_t i = 0; i < count; ++i) {
        improve_run<a, rising>(passed[i].run, passed[i].arc, passed[i].bound);
      }
    }
  }

  template <std::size_t a, bool rising>
  void improve_run(std::size_t r, const Arc* arc, double bound) {
    AxisBounds& bounds = owner_.bounds_[a];
    const LatticeRun& run = owner_.lattice_.axis[a].runs[r];
    const RunHeights<a> heights(*this, run);
    // The test of a run of one segment holds for the segment.
    store(bounds.run[r],
          run.length <= kSegment
              ? pruned_segment<a, rising>(run, heights, 0, run.length, arc)
              : pruned_run<a, rising>(run, heights, arc, bound, &bounds.segment[bounds.first_segment[r]]));
  }

  // Goes up the run segment by segment; returns the largest E left in it.
  template <std::size_t a, bool rising>
  double pruned_run(const LatticeRun& run, const RunHeights<a>& heights, const Arc* arc, double bound,
                    double* segment_bounds) {
    const std::uint32_t segments = (run.length + kSegment - 1) / kSegment;
    double largest = 0;
    bool done = false;  // the rest of the run exceeds all its bounds
    for (std::uint32_t n = 0; n < segments; ++n) {
      const std::uint32_t s = rising ? n : segments - 1 - n;
      const std::uint32_t begin = s * kSegment, end = std::min(begin + kSegment, run.length);
      if (!done) {
        const double h = heights.at(rising ? begin : end - 1);
        climb(arc, h);
        ++counts_.tested;
        done = exceeds(*arc, h, bound);
        if (!done && !exceeds(*arc, h, load(segment_bounds[s]))) {
          store(segment_bounds[s], pruned_segment<a, rising>(run, heights, begin, end, arc));
        }
      }
      largest = std::max(largest, load(segment_bounds[s]));
    }
    return largest;
  }

  // Tests the points of offsets [begin, end) one by one; returns the largest E left among them.
  template <std::size_t a, bool rising>
  double pruned_segment(const LatticeRun& run, const RunHeights<a>& heights, std::uint32_t begin,
                        std::uint32_t end, const Arc* arc) {
    struct Passed {
      const Arc* arc;
      double h;
      std::uint32_t point;
    };
    std::array<Passed, kSegment> passed;
    std::size_t count = 0;
    double largest = 0;
    for (std::uint32_t n = 0; n < end - begin; ++n) {
      const std::uint32_t offset = rising ? begin + n : end - 1 - n;
      const std::uint32_t p = point(a, run, offset);
      const double h = heights.at(offset);
      climb(arc, h);
      const double erosion = owner_.field_.erosion(p);
      const bool exceeded = exceeds(*arc, h, erosion);
      passed[count] = {arc, h, p};
      count += exceeded ? 0 : 1;
      largest = std::max(largest, exceeded ? erosion : 0);
    }
    for (std::size_t i = 0; i < count; ++i) {
      evaluate(passed[i].point, *passed[i].arc, passed[i].h);
      largest = std::max(largest, owner_.field_.erosion(passed[i].point));
    }
    return largest;
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
    bounds.run.assign(lattice.axis[a].runs.size(), kUnbounded);
    bounds.segment.assign(segments, kUnbounded);
  }
}

SweepCounts Sweeper::sweep(const JoinTree& tree, const Vec3& d, std::uint32_t index) {
  return Pass(*this, tree, d, index).run();
}

}  // namespace affskel::core
