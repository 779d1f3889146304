#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "database/sqlite.h"

namespace affskel::server {

/// What is recorded about the field of an erosion that was prepared.
struct FieldShape {
  std::int64_t erosion_id;
  std::int64_t points;
  std::int64_t directions;
  bool finished;
  std::int64_t done;  ///< directions
};

/// Something about a stored field that must not be.  All directions that are done must be computed again:
/// what the lost values came from is not recorded.
struct FieldFault {
  const char* table = nullptr;  ///< "field_chunks", "field_log"; null when no row is at fault, but missing
  std::int64_t id = 0;          ///< of the row
  std::string where;
  std::string what;
};

/// Calls `visit` for every field that is not marked for deletion.
void for_each_field(Database& db, const std::function<void(const FieldShape&)>& visit);

/// Checks the rows of a field: their checksums, sizes and places, and whether each value is one that a report
/// may have brought.
void find_field_faults(Database& db, const FieldShape& field,
                       const std::function<void(FieldFault)>& on_fault);

}  // namespace affskel::server
