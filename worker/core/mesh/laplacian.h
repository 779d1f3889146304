#pragma once

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Laplacian smoothing of a closed surface: so many times every point goes half way to the mean of those that edges join it
/// with (the umbrella operator: Taubin, "A signal processing approach to fair surface design", 1995, with equal weights).
void smooth(Mesh& mesh, int times);

}  // namespace affskel::core
