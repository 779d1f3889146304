#pragma once

#include "check/fault_log.h"
#include "database/sqlite.h"

namespace affskel::server {

/// Checks that the database has the tables, columns, indexes and triggers that the migrations up to `schema`
/// make.  Returns whether it can be read as one of that schema: nothing but indexes or triggers is missing.
bool check_schema(Database& db, int schema, FaultLog& faults);

}  // namespace affskel::server
