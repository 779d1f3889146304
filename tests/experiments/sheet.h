#pragma once

#include "core/mesh/mesh.h"
#include "core/solid/betti_numbers.h"
#include "job.h"

namespace affskel::experiments {

/// The skeleton by the operator `chords` or `ridge`, in mesh units.
struct Sheet {
  Cloud points;  ///< `chords`: where two equal chords meet, on lattice edges; `ridge`: the mesh's vertices
  core::Mesh mesh;
  core::BettiNumbers betti;  ///< of the mesh
};

/// With the operator's default options.
Sheet chord_sheet_of(const Job& job);
Sheet ridge_sheet_of(const Job& job);

}  // namespace affskel::experiments
