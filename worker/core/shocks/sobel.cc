// The threshold.  At a sheet parallel to two axes where the normal component across jumps by J, a point
// beside the sheet gets |H| = J times the weights of a plane: 1 + 2 sqrt(2) + 4 sqrt(3)/3 for Zucker-Hummel,
// 16 here. 7 * 16 / (1 + 2 sqrt(2) + 4 sqrt(3)/3) = 18.247.
#include "core/shocks/sobel.h"

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

std::vector<double> sobel_divergence(const Lattice& lattice, const DirectionSet& directions,
                                     const OptimalDirections& optimal, ExecutionContext* context) {
  return at_every_point(lattice, directions, optimal, context, [](const Neighbourhood& normals) {
    return weighted_plane_differences(normals, {4, 2, 1});
  });
}

}  // namespace affskel::core
