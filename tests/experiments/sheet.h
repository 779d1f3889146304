#pragma once

#include "core/contour/sheet_mesh.h"
#include "core/mesh/mesh.h"
#include "core/solid/betti_numbers.h"
#include "job.h"

namespace affskel::experiments {

/// The skeleton by the operator `chords` or `ridge`, in mesh units.
struct Sheet {
  Cloud points;  ///< `chords`: where two equal chords meet, on lattice edges; `ridge`: the mesh's vertices
  core::Mesh mesh;
  std::vector<core::Segment> segments;   ///< of the curves of `ridge`
  std::vector<core::SkeletonKind> kind;  ///< of `ridge`: of each vertex
  core::BettiNumbers betti;              ///< of both
};

/// With the operator's default options.
Sheet chord_sheet_of(const Job& job);
Sheet ridge_sheet_of(const Job& job);

}  // namespace affskel::experiments
