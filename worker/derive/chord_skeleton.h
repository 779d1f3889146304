#pragma once

#include "affskel/v1/types.pb.h"
#include "derive/finished_field.h"

namespace affskel::worker {

/// The skeleton by equal chords: the shocks on lattice edges that are significant enough.
/// @throws core::CoreError for a wrong parameter.
v1::SkeletonPoints chord_skeleton(const FinishedField& field, const v1::SkeletonParams& params);

/// The sheet through those shocks, with barriers where they are asked for.  @throws core::CoreError for a
/// wrong parameter.
v1::TriangleMesh chord_sheet(const FinishedField& field, const v1::SurfaceParams& params);

}  // namespace affskel::worker
