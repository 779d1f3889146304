#include "core/shocks/shock_operator.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/shocks/average_outward_flux.h"
#include "core/shocks/central_differences.h"
#include "core/shocks/intermediate_differences.h"
#include "core/shocks/sobel.h"
#include "core/shocks/zucker_hummel.h"

namespace affskel::core {
namespace {

[[noreturn]] void unknown() {
  throw CoreError(CoreError::Code::kInternal, "unknown shock operator");
}

}  // namespace

const char* name_of(ShockOperator shock_operator) {
  switch (shock_operator) {
    case ShockOperator::kIntermediate:
      return "intermediate";
    case ShockOperator::kCentral:
      return "central";
    case ShockOperator::kZuckerHummel:
      return "zucker-hummel";
    case ShockOperator::kSobel:
      return "sobel";
    case ShockOperator::kFlux:
      return "flux";
  }
  unknown();
}

double default_threshold(ShockOperator shock_operator, double spacing) {
  switch (shock_operator) {
    case ShockOperator::kIntermediate:
      return intermediate_difference_threshold(spacing);
    case ShockOperator::kCentral:
      return central_difference_threshold(spacing);
    case ShockOperator::kZuckerHummel:
      return kZuckerHummelThreshold;
    case ShockOperator::kSobel:
      return kSobelThreshold;
    case ShockOperator::kFlux:
      return kAverageOutwardFluxThreshold;
  }
  unknown();
}

double next_threshold(double threshold) {
  return std::min(threshold * 9 / 7, std::numeric_limits<double>::max());
}

std::vector<double> divergence(ShockOperator shock_operator, const Lattice& lattice,
                               const DirectionSet& directions, const OptimalDirections& optimal,
                               ExecutionContext* context) {
  switch (shock_operator) {
    case ShockOperator::kIntermediate:
      return intermediate_difference_divergence(lattice, directions, optimal, context);
    case ShockOperator::kCentral:
      return central_difference_divergence(lattice, directions, optimal, context);
    case ShockOperator::kZuckerHummel:
      return zucker_hummel_divergence(lattice, directions, optimal, {}, context);
    case ShockOperator::kSobel:
      return sobel_divergence(lattice, directions, optimal, {}, context);
    case ShockOperator::kFlux:
      return average_outward_flux(lattice, directions, optimal, context);
  }
  unknown();
}

}  // namespace affskel::core
