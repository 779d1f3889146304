#pragma once

#include "core/chords/chord_sheet.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
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

/// The sheet of a job's field, in the frame's coordinates; over all directions with shocks at equal chords.
core::ChordSheet chord_sheet(const Job& job, const core::FrameField& field);

/// With the operator's default options.
Sheet chord_sheet_of(const Job& job);
Sheet ridge_sheet_of(const Job& job);

}  // namespace affskel::experiments
