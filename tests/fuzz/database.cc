// A database whose rows say anything: check tells, the store refuses, and nothing crashes.
#include <sqlite3.h>

#include <array>
#include <cstring>
#include <fstream>

#include "bytes.h"
#include "check/check_database.h"
#include "database/errors.h"
#include "database/sqlite.h"
#include "server/store_fixture.h"
#include "targets.h"

namespace affskel::fuzz {
namespace {

using namespace server;

constexpr int kMostEdits = 4;

// A job that is done, one that is computed, and one that waits.
class Pristine : public StoreTest {
 public:
  Pristine() {
    complete_job(20, 10, "done");
    submit("OFF other", "half");
    prepare(20, 10);
    const v1::Lease half = lease();
    report(half, half.positions(0).begin(), half.positions(0).begin() + 1);
    submit("OFF third", "waiting");
    for (const v1::Job& job : store_->list({}).jobs) jobs.push_back(job.id());
    store_.reset();
    std::ifstream in(database(), std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
    Database db(database(), Database::Mode::kReadOnly);
    Statement row = db.query(
        "SELECT t.name, c.name FROM sqlite_schema t, pragma_table_info(t.name) c"
        " WHERE t.type = 'table' AND t.name NOT LIKE 'sqlite_%' ORDER BY 1, 2");
    while (row.step()) columns.push_back({row.text(0), row.text(1)});
  }
  void TestBody() override {}

  std::string bytes;
  std::vector<std::string> jobs;
  std::vector<std::array<std::string, 2>> columns;
};

const Pristine& pristine() {
  static const Pristine database;
  return database;
}

// What the schema forbids stays as it was.
void edit(sqlite3* db, Bytes& bytes) {
  const auto& columns = pristine().columns;
  const auto& [table, column] = columns[bytes.below_many(columns.size())];
  const std::string sql = "UPDATE \"" + table + "\" SET \"" + column + "\" = ?";
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(db, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) return;
  const unsigned kind = bytes.below(4);
  const std::string_view value = bytes.take(kind == 0 ? sizeof(std::int64_t) : bytes.byte());
  std::int64_t integer = 0;
  if (kind == 0 && !value.empty()) std::memcpy(&integer, value.data(), value.size());
  if (kind == 0) sqlite3_bind_int64(statement, 1, integer);
  if (kind == 1) sqlite3_bind_blob64(statement, 1, value.data(), value.size(), SQLITE_TRANSIENT);
  if (kind == 2) sqlite3_bind_text64(statement, 1, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
  sqlite3_step(statement);
  sqlite3_finalize(statement);
}

void edit_all(const std::string& file, Bytes& bytes) {
  sqlite3* db = nullptr;
  sqlite3_open(file.c_str(), &db);
  sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_exec(db, "PRAGMA ignore_check_constraints = ON; PRAGMA foreign_keys = OFF", nullptr, nullptr,
               nullptr);
  for (int n = 0; n < kMostEdits && !bytes.empty(); ++n) edit(db, bytes);
  sqlite3_close(db);
}

template <typename Call>
void refusing(Call call) {
  try {
    call();
  } catch (const StoreError&) {
  } catch (const SqliteError&) {
  }
}

void use(const std::string& file) {
  TestClock clock;
  Store store(file, {}, clock);
  refusing([&] { store.list({}); });
  for (const std::string& job : pristine().jobs) {
    refusing([&] { store.job(job); });
    for (int kind = v1::ArtifactKind_MIN; kind <= v1::ArtifactKind_MAX; ++kind) {
      refusing([&] {
        const auto state = store.open_artifact(artifact_request(job, static_cast<v1::ArtifactKind>(kind)));
        while (state.reader && !state.reader->next().empty()) {
        }
      });
    }
  }
  refusing([&] {
    const std::optional<v1::Lease> lease = store.lease(worker_identity("worker-b"), "", false);
    if (lease) store.open_input(lease->token(), v1::ARTIFACT_KIND_MESH);
    if (lease) store.give_back(lease->token());
  });
  clock.advance(1'000'000);
  refusing([&] { store.expire_leases(); });
  for (int step = 0; step < 5; ++step) refusing([&] { store.tidy(); });
}

void run(std::string_view input) {
  Bytes bytes(input);
  const tests::TemporaryDirectory directory;
  const std::string file = directory / "affskel.db";
  std::ofstream(file, std::ios::binary) << pristine().bytes;
  edit_all(file, bytes);
  refusing([&] { check_database(directory.path(), [](const Fault&) {}); });
  refusing([&] { use(file); });
}

std::vector<std::string> seeds() {
  return {{0, 1, 0, 5}, {1, 2, 1, 10, 'b', 'y', 't', 'e', 's'}, {0, 60, 2, 4, 'd', 'o', 'n', 'e', 0, 9, 3}};
}

}  // namespace

const Target kDatabase = {"database", seeds, run, 40};

}  // namespace affskel::fuzz
