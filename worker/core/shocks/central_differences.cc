// The threshold.  The published rule is alpha / spacing with alpha "of the order of unity" (Betelu et al.
// 2001). At a sheet parallel to two axes where the normal component across jumps by J <= 2, |H| = J / (2
// spacing): alpha = 1 would keep no point of it even where the normals are opposite.  0.57 stands for the
// jump that Zucker-Hummel's 7 does, J = 1.14.
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
