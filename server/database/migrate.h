#pragma once

#include <cstdint>
#include <vector>

#include "database/sqlite.h"

namespace affskel::server {

/// One step of the schema: server/migrations/NNNN_name.sql.
struct Migration {
  int number;  ///< 1, 2, 3, ...; becomes user_version
  const char* name;
  const char* sql;
};

/// application_id of our files: "AFSL".
inline constexpr std::int64_t kApplicationId = 0x4146534C;

/// "Schema" of a database of the last program before 0.1.0: the tables are those of schema 1 already.
inline constexpr int kBeforeFirst = -1;

/// The migrations compiled into this program, in order.
const std::vector<Migration>& embedded_migrations();

/// The schema that this program brings databases to.
int newest_schema(const std::vector<Migration>& migrations = embedded_migrations());

/// The schema of a database; 0 of an empty one, or kBeforeFirst.
/// @throws StoreError kUnusable when the file is not ours or was written by a newer server; SqliteError.
int checked_schema(Database& db, int newest = newest_schema());

/// Brings the schema up to date, each step in a transaction of its own.  Returns the version reached.
/// @throws StoreError kUnusable when the file is not ours or was written by a newer server; SqliteError.
int migrate(Database& db, const std::vector<Migration>& migrations = embedded_migrations());

}  // namespace affskel::server
