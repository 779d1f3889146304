// Gaussians of a ladder of standard deviations are computed, each for the points whose own width lies between
// its neighbours on the ladder; a point takes the mean of two, weighed by nearness.  A Gaussian is separable:
// along axis 0, then 1, then 2, the last at the points alone.
#include "core/ridge/smoothed_derivatives.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/plain_math.h"
#include "core/base/require.h"
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

// One Gaussian of the ladder, for some of the sample points.
class LadderStep {
 public:
  // weight: of this Gaussian at each sample point; 0 where it is not asked for.
  LadderStep(const Lattice& lattice, const ContinuedField& field, double width, std::span<const float> weight)
      : lattice_(lattice),
        band_(field.band),
        values_(field.values),
        kernels_(kernels_of(width)),
        weight_(weight) {
    const auto rows = static_cast<std::size_t>(end(0)) * static_cast<std::size_t>(end(1));
    asked_.assign(rows, {});
    for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      if (weight[rank] == 0) return;
      Interval& row = asked_[index(i, j)];
      row = row.begin >= row.end ? Interval{k, k + 1} : Interval{row.begin, k + 1};
    });
  }

  void add_to(std::vector<PointDerivatives>& result, ExecutionContext* context) {
    first_.assign(band_.places(), 0.0F);
    second_.assign(band_.places(), 0.0F);
    for (std::size_t a = 0; a <= 2; ++a) {
      throw_if_stopped(context);
      along_first_axis(kernels_.weight[a]);
      for (std::size_t b = 0; a + b <= 2; ++b) {
        along_second_axis(kernels_.weight[b]);
        for (std::size_t c = a + b == 0 ? 1 : 0; a + b + c <= 2; ++c) {
          at_points(kernels_.weight[c],
                    [&](std::uint32_t rank, float value) { entry(result[rank], a, b, c) += value; });
        }
      }
    }
  }

 private:
  struct Interval {
    std::int32_t begin = 0, end = 0;
  };

  std::int32_t end(std::size_t axis) const { return static_cast<std::int32_t>(lattice_.grid.dims[axis]); }
  std::size_t index(std::int32_t i, std::int32_t j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(end(1)) + static_cast<std::size_t>(j);
  }

  // out += weight * the row of `in` at (i, j), between begin and end.
  void add_row(const std::vector<float>& in, std::int32_t i, std::int32_t j, float weight, Interval span,
               float* out, std::int64_t out_offset) const {
    const RowBand::Row& row = band_.row(i, j);
    const std::int32_t first = std::max(span.begin, row.begin), last = std::min(span.end, row.end);
    for (std::int32_t k = first; k < last; ++k)
      out[out_offset + k] += weight * in[static_cast<std::size_t>(row.offset + k)];
  }

  // What the rows of layer i within reach of j, and the kernel along axis 2, will ask for.
  Interval asked_round(std::int32_t i, std::int32_t j) const {
    const std::int32_t reach = kernels_.reach;
    Interval result;
    for (std::int32_t m = std::max(j - reach, 0); m <= std::min(j + reach, end(1) - 1); ++m) {
      const Interval& row = asked_[index(i, m)];
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
    for (std::int32_t i = 0; i < end(0); ++i) {
      for (std::int32_t j = -reach; j < end(1) + reach; ++j) {
        const RowBand::Row& row = band_.row(i, j);
        Interval span = asked_round(i, j);
        span = {std::max(span.begin, row.begin), std::min(span.end, row.end)};
        if (span.begin >= span.end) continue;
        std::fill(first_.begin() + row.offset + span.begin, first_.begin() + row.offset + span.end, 0.0F);
        for (std::int32_t m = -reach; m <= reach; ++m)
          add_row(values_, i + m, j, weights[static_cast<std::size_t>(m + reach)], span, first_.data(),
                  row.offset);
      }
    }
  }

  void along_second_axis(const std::vector<float>& weights) {
    const std::int32_t reach = kernels_.reach;
    for (std::int32_t i = 0; i < end(0); ++i) {
      for (std::int32_t j = 0; j < end(1); ++j) {
        const Interval& row_asked = asked_[index(i, j)];
        if (row_asked.begin >= row_asked.end) continue;
        const Interval span{row_asked.begin - reach, row_asked.end + reach};
        const RowBand::Row& row = band_.row(i, j);
        std::fill(second_.begin() + row.offset + span.begin, second_.begin() + row.offset + span.end, 0.0F);
        for (std::int32_t m = -reach; m <= reach; ++m)
          add_row(first_, i, j + m, weights[static_cast<std::size_t>(m + reach)], span, second_.data(),
                  row.offset);
      }
    }
  }

  template <class Take>
  void at_points(const std::vector<float>& weights, Take take) const {
    const std::int32_t reach = kernels_.reach;
    for (const LatticeRun& run : lattice_.axis[2].runs) {
      const RowBand::Row& row =
          band_.row(static_cast<std::int32_t>(run.start[0]), static_cast<std::int32_t>(run.start[1]));
      const float* at = second_.data() + row.offset + static_cast<std::int32_t>(run.start[2]) - reach;
      for (std::uint32_t n = 0; n < run.length; ++n, ++at) {
        const float share = weight_[run.first + n];
        if (share == 0) continue;
        float sum = 0;
        for (std::size_t m = 0; m < weights.size(); ++m) sum += weights[m] * at[m];
        take(run.first + n, share * sum);
      }
    }
  }

  const Lattice& lattice_;
  const RowBand& band_;
  const std::vector<float>& values_;
  Kernels kernels_;
  std::span<const float> weight_;
  std::vector<Interval> asked_;        // per row: the hull of the points
  std::vector<float> first_, second_;  // per place, after the passes along axes 0 and 1
};

// P and its exact gradient, per spacing, where E may be of any size.
class ScaledField {
 public:
  explicit ScaledField(const FrameField& field) : field_(field) {
    for (const double e : field.erosion)
      if (std::isfinite(e)) highest_ = std::max(highest_, e);
    value_.reserve(field.erosion.size());
    for (const double e : field.erosion)
      value_.push_back(std::sqrt(std::isfinite(e) && highest_ > 0 ? e / highest_ : 0));
  }

  const std::vector<double>& values() const { return value_; }

  // Not kept: three numbers a point where memory is tightest.
  Vec3 gradient(std::uint32_t p) const {
    if (value_[p] <= 0) return {};
    return (0.5 / value_[p]) * ((field_.spacing / highest_) * field_.gradient[p]);
  }

 private:
  const FrameField& field_;
  double highest_ = 0;
  std::vector<double> value_;
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

double width_of(const PointDerivatives& point, const RidgeConstants& constants) {
  return constants.width_at(static_cast<double>(point.depth));
}

// Per point: how far the wider of its Gaussians reaches.
std::vector<std::uint8_t> reaches(const std::vector<float>& depth, const std::vector<double>& ladder,
                                  const RidgeConstants& constants) {
  std::vector<std::uint8_t> result;
  result.reserve(depth.size());
  for (const float d : depth) {
    const auto wider =
        std::lower_bound(ladder.begin(), ladder.end(), constants.width_at(static_cast<double>(d)));
    result.push_back(static_cast<std::uint8_t>(reach_of(wider == ladder.end() ? ladder.back() : *wider)));
  }
  return result;
}

}  // namespace

std::vector<PointDerivatives> smoothed_derivatives(const Lattice& lattice, const FrameField& field,
                                                   ExecutionContext* context,
                                                   const RidgeConstants& constants) {
  const std::vector<float> depth = local_depth(lattice, field);
  double widest = constants.min_width;
  for (const float d : depth) widest = std::max(widest, constants.width_at(static_cast<double>(d)));
  throw_if_stopped(context);
  std::vector<double> ladder{constants.min_width};
  while (ladder.back() < widest)
    ladder.push_back(std::min(ladder.back() * kLadderFactor, constants.max_width));
  std::vector<float> value(depth.size());
  const ContinuedField continued = [&] {
    const ScaledField scaled(field);
    for (std::size_t p = 0; p < value.size(); ++p) value[p] = static_cast<float>(scaled.values()[p]);
    return continued_field(
        lattice, scaled.values(), [&](std::uint32_t p) { return scaled.gradient(p); },
        reaches(depth, ladder, constants));
  }();
  std::vector<PointDerivatives> result(depth.size());  // not before: eleven numbers a point
  for (std::size_t p = 0; p < result.size(); ++p) {
    result[p].depth = depth[p];
    result[p].value = value[p];
  }
  std::vector<float> weight(result.size());
  for (std::size_t step = 0; step < ladder.size(); ++step) {
    throw_if_stopped(context);
    for (std::size_t p = 0; p < result.size(); ++p)
      weight[p] = nearness(width_of(result[p], constants), ladder, step);
    LadderStep(lattice, continued, ladder[step], weight).add_to(result, context);
  }
  return result;
}

}  // namespace affskel::core
