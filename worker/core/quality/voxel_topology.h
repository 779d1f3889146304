#pragma once

#include <span>

#include "core/lattice/lattice_coordinates.h"
#include "core/solid/betti_numbers.h"

namespace affskel::core {

/// Betti numbers of a union of voxels, closed unit cubes about lattice points: the components are those of
/// 26-connected voxels, the cavities the bounded components of 6-connected background, and the holes follow
/// from the Euler characteristic of the cubical complex (Kong and Rosenfeld 1989, section 6).
///
/// Works on runs of voxels along axis 2: linear in the voxels and in the rows (i, j) of their bounding box,
/// whatever its height.
/// @param voxels distinct, in lattice order.
BettiNumbers voxel_betti_numbers(std::span<const LatticePlace> voxels);

}  // namespace affskel::core
