#pragma once

#include <string>

#include "client/commands/context.h"

namespace affskel::client {

/// The sheet of operator chords, whole: for pictures.  Waits while it is computed.
/// @throws ClientError kInternal when a corner is out of range or a vertex lacks E or its strength.
v1::TriangleMesh fetch_sheet(Context& context, const std::string& job, const v1::SkeletonParams& params);

}  // namespace affskel::client
