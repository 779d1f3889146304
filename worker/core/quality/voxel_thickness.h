#pragma once

#include <span>

#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {

/// Mean thickness of a sheet of voxels: voxels per voxel of one layer of it.  A voxel's thickness t is the
/// length of the shortest of the three runs of voxels through it along the axes, which is the one along the
/// axis nearest to the sheet's normal; of t voxels across the sheet each counts as 1/t of a layer, and the
/// mean is n / sum(1/t).  1 for a sheet or a curve that is one voxel thick in any pose (a digital plane has
/// one voxel per line along its steepest axis), m for m such sheets on one another.  0 without voxels.
/// @param voxels distinct, in lattice order.
double mean_voxel_thickness(std::span<const LatticePlace> voxels);

}  // namespace affskel::core
