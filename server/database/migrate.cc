#include "database/migrate.h"

#include <spdlog/spdlog.h>

#include "base/logfmt.h"
#include "database/errors.h"

namespace affskel::server {
namespace {

// Before 0.1.0 databases had this application_id ("AFSK"), and schemas of their own.
constexpr std::int64_t kEarlierId = 0x4146534B;
constexpr int kLastEarlier = 14;

int schema_version(Database& db) {
  return static_cast<int>(db.integer("PRAGMA user_version").value_or(0));
}

int earlier_schema(Database& db) {
  const int version = schema_version(db);
  if (version == kLastEarlier) return kBeforeFirst;
  throw StoreError(StoreError::Code::kUnusable,
                   db.file() + ": written by an affskel-server before 0.1.0 (its schema " +
                       std::to_string(version) + "); the last of these, of schema " +
                       std::to_string(kLastEarlier) + ", brings it up to date");
}

// What the earlier schemas came to is schema 1.
void adopt_earlier(Database& db) {
  Transaction transaction(db);
  db.execute("PRAGMA application_id = " + std::to_string(kApplicationId) + "; PRAGMA user_version = 1");
  transaction.commit();
  spdlog::info(base::logfmt("migrated", {{"schema", 1}, {"name", "earlier"}}));
}

// Tables that are made anew would take along what refers to them, so that foreign keys rest meanwhile.
class ForeignKeysOff {
 public:
  explicit ForeignKeysOff(Database& db) : db_(db) { db_.execute("PRAGMA foreign_keys = OFF"); }
  ~ForeignKeysOff() {
    try {
      db_.execute("PRAGMA foreign_keys = ON");
    } catch (const SqliteError&) {
      // A connection that failed so badly is not used any further.
    }
  }
  ForeignKeysOff(const ForeignKeysOff&) = delete;
  ForeignKeysOff& operator=(const ForeignKeysOff&) = delete;

  void check() const {
    if (db_.integer("SELECT count(*) FROM pragma_foreign_key_check") != 0) {
      throw StoreError(StoreError::Code::kUnusable, db_.file() + ": a migration broke a reference");
    }
  }

 private:
  Database& db_;
};

}  // namespace

int newest_schema(const std::vector<Migration>& migrations) {
  return migrations.empty() ? 0 : migrations.back().number;
}

int checked_schema(Database& db, int newest) {
  const std::int64_t application = db.integer("PRAGMA application_id").value_or(0);
  if (application == kEarlierId) return earlier_schema(db);
  const bool empty = db.integer("SELECT count(*) FROM sqlite_schema") == 0;
  if (application != kApplicationId && !(application == 0 && empty)) {
    throw StoreError(StoreError::Code::kUnusable, db.file() + ": not a database of affskel-server");
  }
  const int version = schema_version(db);
  if (version > newest) {
    throw StoreError(StoreError::Code::kUnusable, db.file() + ": written by a newer affskel-server (schema " +
                                                      std::to_string(version) + ", this one knows up to " +
                                                      std::to_string(newest) +
                                                      "); start that version instead");
  }
  return version;
}

int migrate(Database& db, const std::vector<Migration>& migrations) {
  if (checked_schema(db, newest_schema(migrations)) == kBeforeFirst) adopt_earlier(db);
  const ForeignKeysOff keys(db);
  for (const Migration& step : migrations) {
    Transaction transaction(db);
    if (schema_version(db) >= step.number) continue;
    db.execute(step.sql);
    db.execute("PRAGMA user_version = " + std::to_string(step.number));
    keys.check();
    transaction.commit();
    spdlog::info(base::logfmt("migrated", {{"schema", step.number}, {"name", step.name}}));
  }
  return schema_version(db);
}

}  // namespace affskel::server
