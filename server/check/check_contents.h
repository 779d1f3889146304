#pragma once

#include "check/fault_log.h"
#include "database/sqlite.h"

namespace affskel::server {

/// Checks the stored bytes: meshes and artefacts against their recorded sizes and SHA-256, fields against the
/// number of points and directions, serialized messages for being such.  Requires the newest schema.  What a
/// deleted job has left is passed over: some of it may be gone already.
void check_contents(Database& db, FaultLog& faults);

}  // namespace affskel::server
