#include "check/check_database.h"

#include <optional>
#include <utility>

#include "check/check_contents.h"
#include "check/check_rules.h"
#include "check/check_schema.h"
#include "database/database_file.h"
#include "database/migrate.h"
#include "database/sqlite.h"

namespace affskel::server {
namespace {

class Checker {
 public:
  Checker(std::string file, FaultHandler on_fault, const CheckOptions& options)
      : file_(std::move(file)), faults_(std::move(on_fault), options.most_of_a_kind) {}

  CheckResult check() {
    if (guarded([&] { open(); })) {
      guarded([&] { check_integrity(); });
      guarded([&] { check_references(); });
      guarded([&] { check_content(); });
    }
    result_.faults = faults_.count();
    return result_;
  }

 private:
  /// Runs a part of the check; a place that cannot be read ends that part only.
  template <typename Part>
  bool guarded(Part part) {
    bool read = true;
    try {
      part();
    } catch (const SqliteError& error) {
      if (error.primary_code() != SQLITE_CORRUPT && error.primary_code() != SQLITE_IOERR) throw;
      faults_.add("database", error.what());
      read = false;
    }
    faults_.end_kind();
    return read;
  }

  void open() {
    db_.emplace(file_, Database::Mode::kQueryOnly);
    view_.emplace(*db_, Transaction::Kind::kRead);
    result_.schema = checked_schema(*db_);
  }

  void check_integrity() {
    Statement row = db_->query("PRAGMA integrity_check(1000000000)");  // not the first 100 alone
    while (row.step()) {
      if (row.text(0) != "ok") faults_.add("database", row.text(0));
    }
  }

  void check_references() {
    Statement row = db_->query("PRAGMA foreign_key_check");
    while (row.step()) {
      // Tables without rowids do not tell which row it is.
      const std::string number = row.is_null(1) ? "a row" : "row " + std::to_string(row.integer(1));
      faults_.add("table " + row.text(0), number + " refers to a row of " + row.text(2) + " that is missing");
    }
  }

  void check_content() {
    const bool readable = check_schema(*db_, result_.schema, faults_);
    faults_.end_kind();
    if (!readable || result_.schema < newest_schema()) return;
    result_.complete = true;
    guarded([&] { check_rules(*db_, faults_); });
    guarded([&] { check_contents(*db_, faults_); });
    result_.jobs = count("SELECT count(*) FROM jobs");
    result_.meshes = count("SELECT count(*) FROM meshes");
    result_.fields = count("SELECT count(*) FROM erosions WHERE finished = 1 AND dropped = 0");
    result_.artifacts = count("SELECT count(*) FROM artifacts");
  }

  std::int64_t count(const char* sql) { return db_->integer(sql).value_or(0); }

  std::string file_;
  std::optional<Database> db_;
  std::optional<Transaction> view_;
  FaultLog faults_;
  CheckResult result_;
};

}  // namespace

CheckResult check_database(const std::string& data_dir, const FaultHandler& on_fault,
                           const CheckOptions& options) {
  return Checker(existing_database_file(data_dir), on_fault, options).check();
}

}  // namespace affskel::server
