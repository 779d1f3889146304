// Most solids have the target at dT = (v0 / target)^(1/3), which make_lattice tries first.  Solids thinner
// than that do not: a plate between two layers of points has none, one that a layer runs through has too
// many, and the number of points jumps as dT changes and need not fall as dT grows.  So from `first` dT is
// doubled or halved until the target is bracketed, and the bracket halved in the logarithm until a lattice is
// near.
//
// Where none is, and first of all for foils, spacings round (A / 2 target)^(1/2) are tried, A the area of the
// surface: one layer through the middle of all that is thin.  If that fails, too (two layers have twice the
// points of one), the nearest lattice that was met is taken.
#include "core/lattice/point_spacing.h"

#include <cmath>
#include <limits>

#include "core/base/plain_math.h"
#include "core/solid/surface_samples.h"

namespace affskel::core {
namespace {

constexpr int kMaxDoublings = 60;
constexpr int kMaxHalvings = 24;      // of the bracket in the logarithm: to a part in 10^7
constexpr int kTrials = 24;           // to either side of the spacing of single layers
constexpr double kTrialStep = 0.004;  // between two of them, in the logarithm: 10 % in all

constexpr double kFoilRatio = 4;  // of the spacing to the mean thickness of a foil

class SpacingSearch {
 public:
  SpacingSearch(const Solid& solid, const LatticeOptions& options, double first)
      : solid_(solid), options_(options), best_(first) {}

  double run() {
    if (is_foil(solid_, best_)) {
      best_ = single_layer_spacing();
      try_single_layers();
      if (found_) return best_;
    }
    double low = best_, high = best_;  // with too many points, and with too few
    const bool many = too_many(best_);
    const double factor = many ? 2 : 0.5;
    for (int i = 0; i < kMaxDoublings && !found_; ++i) {
      (many ? high : low) *= factor;
      if (too_many(many ? high : low) != many) break;
      (many ? low : high) *= factor;
    }
    for (int i = 0; i < kMaxHalvings && !found_; ++i) {
      const double middle = std::sqrt(low * high);
      (too_many(middle) ? low : high) = middle;
    }
    try_single_layers();
    return best_;
  }

 private:
  double single_layer_spacing() const {
    return solid_.scale() *
           std::sqrt(surface_area(solid_.mesh) / 2 / static_cast<double>(options_.target_points));
  }

  void try_single_layers() {
    const double middle = single_layer_spacing();
    for (int i = -kTrials; i <= kTrials && !found_; ++i) too_many(middle * plain_exp(i * kTrialStep));
  }

  // A lattice beyond the limits has too many.
  bool too_many(double spacing) {
    options_.spacing = spacing;
    const std::optional<std::uint32_t> points = lattice_points(solid_, options_);
    if (points && *points > 0) consider(spacing, *points);
    return !points || *points > options_.target_points;
  }

  void consider(double spacing, std::uint32_t points) {
    const double ratio = static_cast<double>(points) / static_cast<double>(options_.target_points);
    const double miss = ratio > 1 ? ratio : 1 / ratio;
    if (miss >= min_miss_) return;
    min_miss_ = miss;
    best_ = spacing;
    found_ = is_near(points, options_.target_points);
  }

  const Solid& solid_;
  LatticeOptions options_;
  double best_;
  double min_miss_ = std::numeric_limits<double>::infinity();
  bool found_ = false;
};

}  // namespace

bool is_foil(const Solid& solid, double spacing) {
  const double scaled_volume = solid.scaled(solid.volume);
  return spacing > kFoilRatio * solid.scale() * 2 * scaled_volume / surface_area(solid.mesh);
}

bool is_near(std::uint64_t points, std::uint64_t target) {
  const std::uint64_t miss = points > target ? points - target : target - points;
  return miss <= target / 10;
}

double spacing_for_points(const Solid& solid, const LatticeOptions& options, double first) {
  return SpacingSearch(solid, options, first).run();
}

}  // namespace affskel::core
