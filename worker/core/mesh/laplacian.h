#pragma once

#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Per point of a closed surface the mean of those that edges join it with (the umbrella operator: Taubin, "A signal
/// processing approach to fair surface design", 1995, with equal weights); the point itself where there are none.
std::vector<Vec3> means_of_neighbours(const Mesh& mesh);

/// Laplacian smoothing: so many times every point goes half way to the mean of its neighbours.
void smooth(Mesh& mesh, int times);

}  // namespace affskel::core
