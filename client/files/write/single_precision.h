#pragma once

#include "core/mesh/mesh.h"

namespace affskel::client {

/// Refuses what .stl would spoil, because it holds single precision: see write_surface.
/// @throws ClientError kLimit with the cause, the extent and the formats to take instead.
void check_fits_stl(const core::Mesh& mesh);

}  // namespace affskel::client
