#pragma once

#include <cstdint>
#include <string>

#include "check/fault_log.h"

namespace affskel::server {

struct CheckOptions {
  /// Faults told of each kind; there may be one for every row of a table.
  std::int64_t most_of_a_kind = 100;
};

struct CheckResult {
  int schema = 0;
  bool complete = false;  ///< false: the schema is older or damaged, and nothing is known of the content
  std::int64_t jobs = 0;
  std::int64_t meshes = 0;
  std::int64_t fields = 0;  ///< finished ones
  std::int64_t artifacts = 0;
  std::int64_t faults = 0;  ///< all of them, also those not told
};

/// Checks the database of a data directory as of one moment, whether a server runs there or not: SQLite's own
/// checks of file and references; whether the tables are those of its schema (check_schema.h); then what
/// SQLite cannot know: that rows agree with each other (check_rules.h), that stored bytes have their sizes
/// and hashes (check_contents.h).  Changes nothing in it; SQLite may leave its two files beside it (an empty
/// log and its index).
/// @throws StoreError kUnusable when there is no database of affskel-server, or one of a newer one;
///   SqliteError when it cannot be opened.  What cannot be read later on is a fault.
CheckResult check_database(const std::string& data_dir, const FaultHandler& on_fault,
                           const CheckOptions& options = {});

}  // namespace affskel::server
