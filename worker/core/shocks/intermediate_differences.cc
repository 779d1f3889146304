#include "core/shocks/intermediate_differences.h"

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

std::vector<double> intermediate_difference_divergence(const Lattice& lattice, const DirectionSet& directions,
                                                       const OptimalDirections& optimal,
                                                       ExecutionContext* context) {
  return at_every_point(lattice, directions, optimal, context, [&](const Neighbourhood& normals) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += normals.along(a, 1)[a] - normals.centre()[a];
    return sum / lattice.spacing;
  });
}

}  // namespace affskel::core
