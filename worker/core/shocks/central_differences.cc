#include "core/shocks/central_differences.h"

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

std::vector<double> central_difference_divergence(const Lattice& lattice, const DirectionSet& directions,
                                                  const OptimalDirections& optimal,
                                                  ExecutionContext* context) {
  return at_every_point(lattice, directions, optimal, context, [&](const Neighbourhood& normals) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += normals.along(a, 1)[a] - normals.along(a, -1)[a];
    return sum / (2 * lattice.spacing);
  });
}

}  // namespace affskel::core
