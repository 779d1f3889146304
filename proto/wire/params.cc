#include "wire/params.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "base/direction_set.h"
#include "base/number_text.h"
#include "base/published_threshold.h"
#include "base/ridge_threshold.h"
#include "wire/words.h"

namespace affskel::wire {
namespace {

constexpr std::uint64_t kMaxTargetPoints = std::uint64_t{1} << 31;

v1::SurfaceParams with_barrier(v1::SurfaceParams params) {
  const double least = params.min_barrier();
  if (!std::isfinite(least) || least < 0) {
    throw std::invalid_argument("the least barrier must be a finite number > 0, or 0 for all, not " +
                                base::to_text(least));
  }
  if (least == 0) params.set_min_barrier(0.0);  // == also catches -0
  if (least > 0) params.set_barrier(true);
  const v1::Operator which = params.skeleton().operator_();
  if (params.barrier() && which != v1::OPERATOR_CHORDS && which != v1::OPERATOR_RIDGE) {
    throw std::invalid_argument("barriers are for the sheets of chords and ridge; the operator " +
                                word(which) + " gives points or lines, whose normals have no two sides");
  }
  return params;
}

std::string bits(double value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(value)));
  return text;
}

}  // namespace

std::string canonical_directions(std::string_view text) {
  if (text.empty()) return "triangles";
  std::string joined;
  for (const base::DirectionSetPart& part : base::parse_direction_set(text)) {
    if (part.count > base::kMaxDirections) {
      throw std::invalid_argument(base::direction_set_error(part.text(), "N must be 1 .. 2^24"));
    }
    joined += (joined.empty() ? "" : "+") + part.text();
  }
  return joined;
}

v1::ErosionParams canonical(const v1::ErosionParams& params) {
  v1::ErosionParams result = params;
  const v1::Sampling& sampling = params.sampling();
  switch (sampling.density_case()) {
    case v1::Sampling::kSpacing:
      if (!std::isfinite(sampling.spacing()) || sampling.spacing() <= 0) {
        throw std::invalid_argument("the spacing must be a finite number > 0, not " +
                                    base::to_text(sampling.spacing()));
      }
      break;
    case v1::Sampling::kTargetPoints:
      if (sampling.target_points() < 1 || sampling.target_points() > kMaxTargetPoints) {
        throw std::invalid_argument("the number of sample points aimed at must be 1 .. 2^31, not " +
                                    std::to_string(sampling.target_points()));
      }
      break;
    case v1::Sampling::DENSITY_NOT_SET:
      throw std::invalid_argument("neither a spacing nor a number of sample points is given");
  }
  result.set_directions(canonical_directions(params.directions()));
  if (params.frame() == v1::FRAME_UNSPECIFIED) result.set_frame(v1::FRAME_AXIS);
  if (params.minimum() == v1::MINIMUM_UNSPECIFIED) result.set_minimum(v1::MINIMUM_SET);
  if (!v1::Minimum_IsValid(result.minimum()))
    throw std::invalid_argument("unknown kind of minimum: " +
                                std::to_string(static_cast<int>(result.minimum())));
  if (!v1::Frame_IsValid(result.frame()))
    throw std::invalid_argument("unknown frame of the lattice: " +
                                std::to_string(static_cast<int>(result.frame())));
  return result;
}

v1::SkeletonParams canonical(const v1::SkeletonParams& params) {
  v1::SkeletonParams result = params;
  if (params.operator_() == v1::OPERATOR_UNSPECIFIED) result.set_operator_(kDefaultOperator);
  if (!v1::Operator_IsValid(result.operator_()))
    throw std::invalid_argument("unknown skeleton operator: " +
                                std::to_string(static_cast<int>(result.operator_())));
  if (!std::isfinite(params.threshold()) || params.threshold() < 0) {
    throw std::invalid_argument(
        "the skeleton threshold must be a finite number > 0, or 0 for the default, not " +
        base::to_text(params.threshold()));
  }
  if (result.operator_() == v1::OPERATOR_CHORDS && params.threshold() > 1) {
    throw std::invalid_argument(
        "the threshold of chords is the least share of the skeleton that a piece of it has, between 0 and 1, "
        "not " +
        base::to_text(params.threshold()));
  }
  if (result.operator_() == v1::OPERATOR_RIDGE && params.threshold() != 0 &&
      !(params.threshold() >= base::kMinRidgeThreshold && params.threshold() <= base::kMaxRidgeThreshold)) {
    throw std::invalid_argument(
        "the threshold of ridge is the least strength of its sheet in radians, between " +
        base::to_text(base::kMinRidgeThreshold) + " and " + base::to_text(base::kMaxRidgeThreshold) +
        ", not " + base::to_text(params.threshold()));
  }
  if (result.operator_() == v1::OPERATOR_CURVE && params.threshold() != 0 &&
      !(params.threshold() >= base::kMinCurveThreshold && params.threshold() <= base::kMaxCurveThreshold)) {
    throw std::invalid_argument(
        "the threshold of curve is the length of the shortest limb with a branch, in its own radii, between " +
        base::to_text(base::kMinCurveThreshold) + " and " + base::to_text(base::kMaxCurveThreshold) +
        ", not " + base::to_text(params.threshold()));
  }
  // == also catches -0.  Other operators' defaults depend on the spacing: 0 stays.
  if (params.threshold() == 0) {
    result.set_threshold(result.operator_() == v1::OPERATOR_ZUCKER_HUMMEL ? base::kZuckerHummelThreshold
                                                                          : 0.0);
  }
  return result;
}

v1::SurfaceParams canonical(const v1::SurfaceParams& params) {
  v1::SurfaceParams result = params;
  if (!std::isfinite(params.alpha()) || params.alpha() < 0) {
    throw std::invalid_argument("alpha must be a finite number > 0, or 0 for the default, not " +
                                base::to_text(params.alpha()));
  }
  if (params.alpha() == 0) result.set_alpha(0.0);
  *result.mutable_skeleton() = canonical(params.skeleton());
  if (gives_sheet(result.skeleton().operator_()) && result.alpha() != 0) {
    throw std::invalid_argument("alpha is for point skeletons; the sheet of " +
                                word(result.skeleton().operator_()) + " has triangles of its own");
  }
  return with_barrier(std::move(result));
}

v1::ErodedParams canonical(const v1::ErodedParams& params) {
  v1::ErodedParams result = params;
  switch (params.level_case()) {
    case v1::ErodedParams::kFraction:
      if (!(params.fraction() > 0 && params.fraction() < 1)) {
        throw std::invalid_argument("the fraction of the volume must be a number between 0 and 1, not " +
                                    base::to_text(params.fraction()));
      }
      break;
    case v1::ErodedParams::kVolume:
      if (!std::isfinite(params.volume()) || params.volume() <= 0) {
        throw std::invalid_argument("the volume must be a finite number > 0, not " +
                                    base::to_text(params.volume()));
      }
      break;
    case v1::ErodedParams::LEVEL_NOT_SET:
      result.set_fraction(kErodedFraction);
  }
  return result;
}

bool gives_sheet(v1::Operator which) {
  return which == v1::OPERATOR_CHORDS || which == v1::OPERATOR_RIDGE || which == v1::OPERATOR_CURVE;
}

v1::Operator usual_divergence(v1::Operator of_job) {
  return gives_sheet(of_job) ? v1::OPERATOR_ZUCKER_HUMMEL : of_job;
}

v1::SkeletonParams divergence_params(const v1::SkeletonParams& params) {
  if (gives_sheet(params.operator_())) {
    throw std::invalid_argument("the operator " + word(params.operator_()) +
                                " gives a sheet and has no divergence");
  }
  v1::SkeletonParams result;
  result.set_operator_(params.operator_());
  return result;
}

std::string cache_key(const v1::ErosionParams& params) {
  const v1::Sampling& sampling = params.sampling();
  const std::string density = sampling.density_case() == v1::Sampling::kSpacing
                                  ? "spacing=" + bits(sampling.spacing())
                                  : "points=" + std::to_string(sampling.target_points());
  // Keys from before there were frames stay valid.
  const std::string frame =
      params.frame() == v1::FRAME_AXIS ? "" : " frame=" + std::to_string(static_cast<int>(params.frame()));
  // The same goes for minima; the server's schema knows an infimum by this word.
  const std::string minimum = params.minimum() == v1::MINIMUM_INFIMUM ? " minimum=infimum" : "";
  return density + " directions=" + params.directions() + " repair=" + (params.repair() ? "1" : "0") + frame +
         minimum;
}

std::string cache_key(const v1::SkeletonParams& params) {
  return "operator=" + std::to_string(static_cast<int>(params.operator_())) +
         " threshold=" + bits(params.threshold());
}

std::string cache_key(const v1::SurfaceParams& params) {
  // Keys from before there were barriers stay valid.
  const std::string barrier = params.barrier() ? " barrier=" + bits(params.min_barrier()) : "";
  return cache_key(params.skeleton()) + " alpha=" + bits(params.alpha()) + barrier;
}

std::string cache_key(const v1::ErodedParams& params) {
  return params.level_case() == v1::ErodedParams::kVolume ? "volume=" + bits(params.volume())
                                                          : "fraction=" + bits(params.fraction());
}

}  // namespace affskel::wire
