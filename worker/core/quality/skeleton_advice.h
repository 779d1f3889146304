#pragma once

#include <string>
#include <vector>

#include "core/chords/chord_pruning.h"
#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"
#include "core/shocks/shock_operator.h"

namespace affskel::core {

/// Why a thresholded skeleton is empty and what to try, one or more sentences for people: the largest |H|
/// there is and a threshold that would keep about as many points as a sheet through the lattice has; few
/// distinct optimal normals (a box has six: too few for shocks to show); too few sample points.
/// @param divergence H per sample point, none with |H| > threshold.
std::string empty_skeleton_advice(const Lattice& lattice, const OptimalDirections& optimal,
                                  const std::vector<double>& divergence, ShockOperator shock_operator,
                                  double threshold);

/// The same for the operator `chords`.  There are no two equal chords at all; or none of clearly different
/// directions (then with the widest angle there is, and other axes when the lattice's are stretched: a flat
/// solid becomes as thick as it is wide in the frame `affine`, and its chords no longer oppose each other);
/// or only where E is small; or only in pieces below the significance (then with one that keeps the
/// heaviest).
/// @param census of a sheet without shocks.
/// @param pruning the options that it was made with.
std::string empty_sheet_advice(const Lattice& lattice, const ShockCensus& census,
                               const ChordPruningOptions& pruning);

}  // namespace affskel::core
