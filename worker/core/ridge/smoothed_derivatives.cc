// Gaussians of a ladder of standard deviations are computed, each for the points whose own width lies between
// its neighbours on the ladder; a point takes the mean of two, weighed by nearness.  A Gaussian is separable:
// along axis 0, then 1, then 2, the last at the points alone.
#include "core/ridge/smoothed_derivatives.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/parallel.h"
#include "core/base/plain_math.h"
#include "core/base/vec3.h"
#include "core/ridge/continued_field.h"
#include "core/ridge/local_depth.h"
#include "core/ridge/row_band.h"

namespace affskel::core {
namespace {

constexpr double kReach = 2.5;         // of a kernel, standard deviations
constexpr double kLadderFactor = 1.5;  // from one standard deviation to the next

std::int32_t reach_of(double width) {
  return static_cast<std::int32_t>(std::ceil(kReach * width));
}

// Weights w_m, m = -reach .. reach, of the derivatives of order 0, 1 and 2: sum w_m f(x + m) is that of f,
// exactly so for polynomials of degree 2.
struct Kernels {
  std::int32_t reach = 0;
  std::array<std::vector<float>, 3> weight;
};

Kernels kernels_of(double width) {
  Kernels kernels;
  kernels.reach = reach_of(width);
  const double step = plain_exp(-0.5 / (width * width));  // g_m = step^(m^2)
  std::vector<double> g{1};
  double ratio = step;
  for (std::int32_t m = 1; m <= kernels.reach; ++m, ratio *= step * step) g.push_back(g.back() * ratio);
  double m0 = 0, m2 = 0, m4 = 0;
  for (std::int32_t m = -kernels.reach; m <= kernels.reach; ++m) {
    const double weight = g[static_cast<std::size_t>(std::abs(m))], square = static_cast<double>(m * m);
    m0 += weight;
    m2 += weight * square;
    m4 += weight * square * square;
  }
  for (std::int32_t m = -kernels.reach; m <= kernels.reach; ++m) {
    const double weight = g[static_cast<std::size_t>(std::abs(m))], square = static_cast<double>(m * m);
    kernels.weight[0].push_back(static_cast<float>(weight / m0));
    kernels.weight[1].push_back(static_cast<float>(weight * m / m2));
    kernels.weight[2].push_back(static_cast<float>(2 * weight * (square - m2 / m0) / (m4 - m2 * m2 / m0)));
  }
  return kernels;
}

// Which entry of PointDerivatives a derivative of these orders is.
float& entry(PointDerivatives& point, std::size_t a, std::size_t b, std::size_t c) {
  if (a + b + c == 1) return point.gradient[b + 2 * c];
  if (a == 2) return point.hessian[0];
  if (a == 1) return point.hessian[b == 1 ? 1 : 2];
  return point.hessian[b == 2 ? 3 : b == 1 ? 4 : 5];
}

// One Gaussian of the ladder, for the sample points that ask for it: layer by layer across axis 0, so that between the
// passes no more is kept than a layer.
class LadderStep {
 public:
  LadderStep(const Lattice& lattice, const ContinuedField& field, double width)
      : lattice_(lattice), band_(field.band), values_(field.values), kernels_(kernels_of(width)) {}

  // @param layer the runs of one.
  // @param weight weight(point): of this Gaussian at a sample point; 0 where it is not asked for.
  template <class Weight>
  void add_to(std::vector<PointDerivatives>& result, std::span<const LatticeRun> layer,
              const Weight& weight) {
    if (!ask(layer, weight)) return;
    for (std::size_t a = 0; a <= 2; ++a) {
      along_first_axis(kernels_.weight[a]);
      for (const LatticeRun& points : layer) add_run(points, layer.front().first, a, result);
    }
  }

 private:
  struct Interval {
    std::int32_t begin = 0, end = 0;
  };

  std::int32_t end(std::size_t axis) const { return static_cast<std::int32_t>(lattice_.grid.dims[axis]); }

  // Notes what the points of a layer ask for. @return false when that is nothing.
  template <class Weight>
  bool ask(std::span<const LatticeRun> layer, const Weight& weight) {
    layer_ = static_cast<std::int32_t>(layer.front().start[0]);
    weight_.clear();
    asked_.assign(static_cast<std::size_t>(end(1)), {});
    bool any = false;
    for (const LatticeRun& run : layer) {
      Interval& row = asked_[run.start[1]];
      for (std::uint32_t n = 0; n < run.length; ++n) {
        weight_.push_back(weight(run.first + n));
        if (weight_.back() == 0) continue;
        const auto k = static_cast<std::int32_t>(run.start[2] + n);
        row = row.begin >= row.end ? Interval{k, k + 1} : Interval{row.begin, k + 1};
        any = true;
      }
    }
    return any;
  }

  // out += weight * a row that begins at `in`, between begin and end.
  static void add_row(const float* in, const RowBand::Row& row, float weight, Interval span, float* out) {
    const std::int32_t first = std::max(span.begin, row.begin), last = std::min(span.end, row.end);
    for (std::int32_t k = first; k < last; ++k) out[k - span.begin] += weight * in[k - row.begin];
  }

  // What the rows of the layer within reach of j, and the kernel along axis 2, will ask for.
  Interval asked_round(std::int32_t j) const {
    const std::int32_t reach = kernels_.reach;
    Interval result;
    for (std::int32_t m = std::max(j - reach, 0); m <= std::min(j + reach, end(1) - 1); ++m) {
      const Interval& row = asked_[static_cast<std::size_t>(m)];
      if (row.begin >= row.end) continue;
      result = result.begin >= result.end
                   ? row
                   : Interval{std::min(result.begin, row.begin), std::max(result.end, row.end)};
    }
    if (result.begin >= result.end) return {};
    return {result.begin - reach, result.end + reach};
  }

  void along_first_axis(const std::vector<float>& weights) {
    const std::int32_t reach = kernels_.reach;
    first_rows_.clear();
    first_.clear();
    for (std::int32_t j = -reach; j < end(1) + reach; ++j) {
      const RowBand::Row& row = band_.row(layer_, j);
      Interval span = asked_round(j);
      span = {std::max(span.begin, row.begin), std::min(span.end, row.end)};
      first_rows_.push_back({span.begin, span.end, std::ssize(first_)});
      if (span.begin >= span.end) continue;
      first_.resize(first_.size() + static_cast<std::size_t>(span.end - span.begin), 0.0F);
      for (std::int32_t m = -reach; m <= reach; ++m) {
        const RowBand::Row& from = band_.row(layer_ + m, j);
        add_row(values_.data() + from.offset + from.begin, from, weights[static_cast<std::size_t>(m + reach)],
                span, first_.data() + first_rows_.back().offset);
      }
    }
  }

  // The points of a run, whose layer's first one is `first`, after a pass of order `a` along axis 0.
  void add_run(const LatticeRun& run, std::uint32_t first, std::size_t a,
               std::vector<PointDerivatives>& result) {
    const std::span weights(weight_.begin() + (run.first - first), run.length);
    if (std::all_of(weights.begin(), weights.end(), [](float weight) { return weight == 0; })) return;
    const auto j = static_cast<std::int32_t>(run.start[1]), k = static_cast<std::int32_t>(run.start[2]);
    const Interval span{k - kernels_.reach, k + static_cast<std::int32_t>(run.length) + kernels_.reach};
    for (std::size_t b = 0; a + b <= 2; ++b) {
      along_second_axis(kernels_.weight[b], j, span);
      for (std::size_t c = a + b == 0 ? 1 : 0; a + b + c <= 2; ++c)
        for (std::uint32_t n = 0; n < run.length; ++n)
          if (weights[n] != 0)
            entry(result[run.first + n], a, b, c) += weights[n] * at(n, kernels_.weight[c]);
    }
  }

  void along_second_axis(const std::vector<float>& weights, std::int32_t j, Interval span) {
    second_.assign(static_cast<std::size_t>(span.end - span.begin), 0.0F);
    for (std::size_t m = 0; m < weights.size(); ++m) {
      const RowBand::Row& from = first_rows_[static_cast<std::size_t>(j) + m];
      add_row(first_.data() + from.offset, from, weights[m], span, second_.data());
    }
  }

  float at(std::size_t n, const std::vector<float>& weights) const {
    float sum = 0;
    for (std::size_t m = 0; m < weights.size(); ++m) sum += weights[m] * second_[n + m];
    return sum;
  }

  const Lattice& lattice_;
  const RowBand& band_;
  const std::vector<float>& values_;
  Kernels kernels_;
  std::int32_t layer_ = 0;
  std::vector<float> weight_;             // per sample point of the layer
  std::vector<Interval> asked_;           // per row of it: the hull of the points
  std::vector<float> first_;              // after the pass along axis 0: rows of the layer from -reach on
  std::vector<RowBand::Row> first_rows_;  // where they are in it
  std::vector<float> second_;             // after the pass along axis 1: about a run
};

// The runs of each layer across axis 0.
std::vector<std::span<const LatticeRun>> layers_of(const Lattice& lattice) {
  std::vector<std::span<const LatticeRun>> layers;
  const auto& runs = lattice.axis[2].runs;
  for (auto run = runs.begin(); run != runs.end(); run += std::ssize(layers.back()))
    layers.emplace_back(run, std::find_if(run, runs.end(), [&](const LatticeRun& other) {
                          return other.start[0] != run->start[0];
                        }));
  return layers;
}

// P and its exact gradient, per spacing, where E may be of any size.  Not kept: memory is tightest here.
class ScaledField {
 public:
  explicit ScaledField(const FrameField& field) : field_(field) {
    for (const double e : field.erosion)
      if (std::isfinite(e)) highest_ = std::max(highest_, e);
  }

  double value(std::uint32_t p) const {
    const double e = field_.erosion[p];
    return std::sqrt(std::isfinite(e) && highest_ > 0 ? e / highest_ : 0);
  }

  Vec3 gradient(std::uint32_t p) const {
    const double here = value(p);
    if (here <= 0) return {};
    return (0.5 / here) * ((field_.spacing / highest_) * field_.gradient[p]);
  }

 private:
  const FrameField& field_;
  double highest_ = 0;
};

// Between the ladder's Gaussians `below` and the next: 1 at its own width, 0 at its neighbours'.
float nearness(double width, const std::vector<double>& ladder, std::size_t step) {
  if (width < ladder[step])
    return step == 0 ? 1.0F
                     : static_cast<float>(
                           std::max(0.0, (width - ladder[step - 1]) / (ladder[step] - ladder[step - 1])));
  if (step + 1 == ladder.size()) return 1.0F;
  return static_cast<float>(std::max(0.0, (ladder[step + 1] - width) / (ladder[step + 1] - ladder[step])));
}

// Per point: how far the wider of its Gaussians reaches.
std::vector<std::uint8_t> reaches(const std::vector<float>& depth, const std::vector<double>& ladder,
                                  const RidgeWidths& widths) {
  std::vector<std::uint8_t> result;
  result.reserve(depth.size());
  for (const float d : depth) {
    const auto wider = std::lower_bound(ladder.begin(), ladder.end(), widths.at(static_cast<double>(d)));
    result.push_back(static_cast<std::uint8_t>(reach_of(wider == ladder.end() ? ladder.back() : *wider)));
  }
  return result;
}

}  // namespace

std::vector<PointDerivatives> smoothed_derivatives(const Lattice& lattice, const FrameField& field,
                                                   unsigned threads, ExecutionContext* context,
                                                   const RidgeWidths& widths) {
  std::vector<float> depth = local_depth(lattice, field, context);
  double widest = widths.least;
  for (const float d : depth) widest = std::max(widest, widths.at(static_cast<double>(d)));
  throw_if_stopped(context);
  std::vector<double> ladder{widths.least};
  while (ladder.back() < widest) ladder.push_back(std::min(ladder.back() * kLadderFactor, widths.greatest));
  const ScaledField scaled(field);
  const ContinuedField continued = continued_field(
      lattice, [&](std::uint32_t p) { return scaled.value(p); },
      [&](std::uint32_t p) { return scaled.gradient(p); }, reaches(depth, ladder, widths), threads);
  std::vector<PointDerivatives> result(depth.size());  // not before: eleven numbers a point
  for (std::uint32_t p = 0; p < result.size(); ++p) {
    result[p].depth = depth[p];
    result[p].value = static_cast<float>(scaled.value(p));
  }
  std::vector<float>().swap(depth);
  const std::vector<std::span<const LatticeRun>> layers = layers_of(lattice);
  for (std::size_t step = 0; step < ladder.size(); ++step) {
    const auto weight = [&](std::uint32_t p) {
      return nearness(widths.at(static_cast<double>(result[p].depth)), ladder, step);
    };
    parallel_for(threads, threads,
                 [&](std::size_t part) {  // layers of one remainder: they are unevenly large
                   LadderStep gaussian(lattice, continued, ladder[step]);
                   for (std::size_t n = part; n < layers.size(); n += threads) {
                     throw_if_stopped(context);
                     gaussian.add_to(result, layers[n], weight);
                   }
                 });
  }
  return result;
}

}  // namespace affskel::core
