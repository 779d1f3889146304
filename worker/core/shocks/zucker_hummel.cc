#include "core/shocks/zucker_hummel.h"

#include <numbers>

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

std::vector<double> zucker_hummel_divergence(const Lattice& lattice, const DirectionSet& directions,
                                             const OptimalDirections& optimal, ExecutionContext* context) {
  return at_every_point(lattice, directions, optimal, context, [](const Neighbourhood& normals) {
    return weighted_plane_differences(normals, {1, std::numbers::sqrt2 / 2, std::numbers::inv_sqrt3});
  });
}

}  // namespace affskel::core
