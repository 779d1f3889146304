#pragma once

#include "check/fault_log.h"
#include "database/sqlite.h"

namespace affskel::server {

/// Checks how the rows of different tables go together: what the server keeps true with every transaction and
/// no constraint of the schema says.  Requires the newest schema.
void check_rules(Database& db, FaultLog& faults);

}  // namespace affskel::server
