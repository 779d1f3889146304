#pragma once

#include <span>
#include <vector>

#include "core/collapse/dual_complex.h"
#include "core/collapse/limb_tips.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Which limbs may be spikes that noise has pulled out of the surface: those about whose tips it crosses itself, no
/// farther away than the surface and a spacing.
/// @param walls the solid's surface in lattice coordinates.
/// @param radius per sample point: distance to the surface, spacings.
/// @return per limb; empty where the surface does not cross itself.
std::vector<char> noisy_limbs(const Solid& solid, const Mesh& walls, const Lattice& lattice,
                              const DualComplex& complex, std::span<const float> radius,
                              std::span<const LimbTip> limbs);

}  // namespace affskel::core
