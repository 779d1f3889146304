#pragma once

#include <span>

#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {

/// Mean thickness of a sheet of voxels, in voxels: 1 for a sheet or a curve that is one voxel thick in any
/// pose, m for m such sheets on one another, 0 without voxels.  The thickness t at a voxel is the length of
/// the shortest of the three runs of voxels through it along the axes, and the mean is n / sum(1/t).
/// @param voxels distinct, in lattice order.
double mean_voxel_thickness(std::span<const LatticePlace> voxels);

}  // namespace affskel::core
