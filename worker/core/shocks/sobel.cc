#include "core/shocks/sobel.h"

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

std::vector<double> sobel_divergence(const Lattice& lattice, const DirectionSet& directions,
                                     const OptimalDirections& optimal, const SobelOptions& options,
                                     ExecutionContext* context) {
  return at_every_point(lattice, directions, optimal, context, [&](const Neighbourhood& normals) {
    return weighted_plane_differences(normals,
                                      {options.face_weight, options.edge_weight, options.corner_weight});
  });
}

}  // namespace affskel::core
