#include "database/sqlite.h"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>

#include "database/migrate.h"
#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

class DatabaseTest : public testing::Test {
 protected:
  std::string file() const { return (directory_.path() / "test.db").string(); }
  TemporaryDirectory directory_;
};

/// A mesh and its erosion 1, for rows that refer to them.
void add_erosion(Database& db, const std::string& sha256) {
  db.run("INSERT INTO meshes (sha256, bytes, created_ms) VALUES (?, 3, 0)", sha256);
  db.run("INSERT INTO erosions (id, mesh_sha256, params, params_key) VALUES (1, ?, x'', '')", sha256);
}

TEST_F(DatabaseTest, OpensDurablyAndWithForeignKeys) {
  Database db(file(), Database::Mode::kReadWrite);
  Statement mode = db.query("PRAGMA journal_mode");
  ASSERT_TRUE(mode.step());
  EXPECT_EQ(mode.text(0), "wal");
  EXPECT_EQ(db.integer("PRAGMA synchronous"), 2);  // FULL
  EXPECT_EQ(db.integer("PRAGMA foreign_keys"), 1);
}

// The journal's bound is in bytes, whatever the pages of a database that an older version made.
TEST_F(DatabaseTest, KeepsThePagesItWasMadeWithAndBoundsTheJournalInBytes) {
  constexpr std::int64_t kJournalBytes = std::int64_t{64} << 20;
  {
    Database db(file(), Database::Mode::kReadWrite);
    EXPECT_EQ(db.integer("PRAGMA page_size"), 16384);
    EXPECT_EQ(db.integer("PRAGMA wal_autocheckpoint"), kJournalBytes / 16384);
    db.execute("PRAGMA journal_mode = DELETE; PRAGMA page_size = 4096; VACUUM");
  }
  Database db(file(), Database::Mode::kReadWrite);
  EXPECT_EQ(db.integer("PRAGMA page_size"), 4096);
  EXPECT_EQ(db.integer("PRAGMA wal_autocheckpoint"), kJournalBytes / 4096);
}

TEST_F(DatabaseTest, BindsAndReadsEveryType) {
  Database db(file(), Database::Mode::kReadWrite);
  const std::string bytes("\0\1\xff", 3);
  Statement row =
      db.query("SELECT ?, ?, ?, ?, ?", std::int64_t{-7}, 0.1, "text", Blob{bytes}, std::optional<double>());
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.integer(0), -7);
  EXPECT_EQ(row.real(1), 0.1);
  EXPECT_EQ(row.text(2), "text");
  EXPECT_EQ(row.blob(3), bytes);
  EXPECT_TRUE(row.is_null(4));
  EXPECT_FALSE(row.step());
}

TEST_F(DatabaseTest, StatementInUseTwiceAtOnce) {
  Database db(file(), Database::Mode::kReadWrite);
  const char* sql = "SELECT value FROM (SELECT 1 AS value UNION SELECT 2) WHERE value >= ?";
  Statement outer = db.query(sql, 1);
  ASSERT_TRUE(outer.step());
  Statement inner = db.query(sql, 2);
  ASSERT_TRUE(inner.step());
  EXPECT_EQ(inner.integer(0), 2);
  EXPECT_EQ(outer.integer(0), 1);
  EXPECT_TRUE(outer.step());
}

TEST_F(DatabaseTest, TransactionRollsBackUnlessCommitted) {
  Database db(file(), Database::Mode::kReadWrite);
  db.execute("CREATE TABLE t (x INTEGER) STRICT");
  {
    Transaction transaction(db);
    db.run("INSERT INTO t VALUES (1)");
  }
  EXPECT_EQ(db.integer("SELECT count(*) FROM t"), 0);
  {
    Transaction transaction(db);
    db.run("INSERT INTO t VALUES (1)");
    transaction.commit();
  }
  EXPECT_EQ(db.integer("SELECT count(*) FROM t"), 1);
}

// Room on the disk, not only a length, for what waits in the log; in steps of a mebibyte.
TEST_F(DatabaseTest, ClaimsThePagesOfATransactionBeforeItIsCommitted) {
  Database db(file(), Database::Mode::kReadWrite);
  db.execute("CREATE TABLE t (x BLOB) STRICT");
  Transaction transaction(db);
  db.run("INSERT INTO t VALUES (zeroblob(5000000))");
  db.claim_pages();
  struct stat status {};
  ASSERT_EQ(stat(file().c_str(), &status), 0);
  EXPECT_EQ(status.st_size, 5 << 20);
  EXPECT_GE(status.st_blocks * 512, status.st_size);
  transaction.commit();
  EXPECT_TRUE(db.checkpoint());
  EXPECT_EQ(db.integer("SELECT length(x) FROM t"), 5000000);
}

TEST_F(DatabaseTest, ErrorsCarryExtendedCodes) {
  Database db(file(), Database::Mode::kReadWrite);
  db.execute("CREATE TABLE t (x INTEGER PRIMARY KEY) STRICT");
  db.run("INSERT INTO t VALUES (1)");
  try {
    db.run("INSERT INTO t VALUES (1)");
    FAIL() << "no error";
  } catch (const SqliteError& error) {
    EXPECT_EQ(error.extended_code(), SQLITE_CONSTRAINT_PRIMARYKEY);
  }
}

// In words that say what to do, with the file and without a statement.
TEST_F(DatabaseTest, DamageIsToldInWords) {
  {
    Database db(file(), Database::Mode::kReadWrite);
    db.execute("CREATE TABLE t (x TEXT); INSERT INTO t VALUES ('a')");
  }
  std::int64_t root = 0;
  {
    Database db(file(), Database::Mode::kReadOnly);
    root = db.integer("SELECT rootpage FROM sqlite_schema").value();
  }
  {
    std::fstream bytes(file(), std::ios::binary | std::ios::in | std::ios::out);
    bytes.seekp((root - 1) * 16384);
    bytes << std::string(16384, '\xa5');
  }
  Database db(file(), Database::Mode::kReadOnly);
  try {
    db.integer("SELECT count(*) FROM t");
    ADD_FAILURE() << "read";
  } catch (const SqliteError& error) {
    EXPECT_TRUE(error.says_damaged());
    EXPECT_FALSE(error.says_device());
    const std::string message = error.what();
    EXPECT_NE(message.find(file() + ": is damaged"), std::string::npos) << message;
    EXPECT_NE(message.find("check --repair"), std::string::npos) << message;
    EXPECT_EQ(message.find("SELECT"), std::string::npos) << message;
  }
}

TEST_F(DatabaseTest, MigratesFromEmptyOnce) {
  Database db(file(), Database::Mode::kReadWrite);
  EXPECT_EQ(migrate(db), embedded_migrations().back().number);
  EXPECT_EQ(db.integer("PRAGMA application_id"), kApplicationId);
  EXPECT_EQ(db.integer("PRAGMA user_version"), embedded_migrations().back().number);
  EXPECT_EQ(migrate(db), embedded_migrations().back().number);
}

TEST_F(DatabaseTest, AppliesOnlyWhatIsMissing) {
  Database db(file(), Database::Mode::kReadWrite);
  std::vector<Migration> migrations = embedded_migrations();
  migrate(db, migrations);
  migrations.push_back({migrations.back().number + 1, "next", "CREATE TABLE added (x INTEGER) STRICT;"});
  EXPECT_EQ(migrate(db, migrations), migrations.back().number);
  EXPECT_EQ(db.integer("SELECT count(*) FROM added"), 0);
}

TEST_F(DatabaseTest, FailedMigrationChangesNothing) {
  Database db(file(), Database::Mode::kReadWrite);
  std::vector<Migration> migrations = embedded_migrations();
  migrate(db, migrations);
  migrations.push_back(
      {migrations.back().number + 1, "bad", "CREATE TABLE half (x INTEGER) STRICT; NONSENSE;"});
  EXPECT_THROW(migrate(db, migrations), SqliteError);
  EXPECT_EQ(db.integer("SELECT count(*) FROM sqlite_schema WHERE name = 'half'"), 0);
  EXPECT_EQ(db.integer("PRAGMA user_version"), embedded_migrations().back().number);
}

/// As the last program before 0.1.0 left it.
void make_earlier(Database& db, int schema) {
  db.execute("PRAGMA application_id = 1095127883; PRAGMA user_version = " + std::to_string(schema));
}

TEST_F(DatabaseTest, ADatabaseOfTheLastProgramBefore010IsTakenOver) {
  Database db(file(), Database::Mode::kReadWrite);
  migrate(db, {embedded_migrations().front()});
  add_erosion(db, std::string(64, 'a'));
  make_earlier(db, 14);
  EXPECT_EQ(checked_schema(db), kBeforeFirst);
  EXPECT_EQ(migrate(db), newest_schema());
  EXPECT_EQ(checked_schema(db), newest_schema());
  EXPECT_EQ(db.integer("PRAGMA application_id"), kApplicationId);
  EXPECT_EQ(db.integer("SELECT count(*) FROM erosions"), 1);
  EXPECT_EQ(migrate(db), newest_schema());
}

TEST_F(DatabaseTest, ThoseOfProgramsBeforeThatAreRefusedByName) {
  Database db(file(), Database::Mode::kReadWrite);
  migrate(db);
  make_earlier(db, 13);
  try {
    migrate(db);
    FAIL();
  } catch (const StoreError& error) {
    EXPECT_EQ(error.code(), StoreError::Code::kUnusable);
    EXPECT_NE(std::string(error.what()).find("before 0.1.0 (its schema 13)"), std::string::npos)
        << error.what();
  }
  EXPECT_EQ(db.integer("PRAGMA user_version"), 13);
}

TEST_F(DatabaseTest, TriggersKeepTheQueueOfOwners) {
  Database db(file(), Database::Mode::kReadWrite);
  migrate(db);
  db.execute("INSERT INTO task_kinds (name) VALUES ('prepare')");
  const std::string sha(64, 'a');
  db.run("INSERT INTO meshes (sha256, bytes, created_ms) VALUES (?, 3, 0)", sha);
  const auto add = [&](int seq, const char* owner, int priority, const char* state) {
    db.run("INSERT INTO erosions (id, mesh_sha256, params, params_key) VALUES (?, ?, x'', '')", seq, sha);
    db.run(
        "INSERT INTO jobs (seq, id, name, owner, priority, state, stage, erosion_id, skeleton, skeleton_key,"
        " created_ms) VALUES (?1, printf('%032d', ?1), 'n', ?2, ?3, ?4, 'prepare', ?1, x'', '', 0)",
        seq, owner, priority, state);
    db.run(
        "INSERT INTO tasks (job_id, kind, state, seq, owner, priority, parked)"
        " VALUES (printf('%032d', ?1), 'prepare', 'pending', ?1, ?2, ?3, ?4)",
        seq, owner, priority, std::string(state) == "cancelled");
  };
  add(3, "bob", 5, "queued");
  add(4, "ada", 5, "queued");
  add(5, "bob", 5, "queued");
  add(6, "bob", 9, "cancelled");
  const auto lines = [&](const char* sql) {
    std::string text;
    Statement row = db.query(sql);
    while (row.step()) text += row.text(0) + ";";
    return text;
  };
  EXPECT_EQ(lines("SELECT owner || ' ' || priority || ' ' || ready FROM queues ORDER BY turn"),
            "bob 5 2;ada 5 1;");
  db.run("UPDATE jobs SET state = 'queued' WHERE seq = 6");
  EXPECT_EQ(lines("SELECT owner || ' ' || priority || ' ' || ready FROM queues ORDER BY priority, turn"),
            "bob 5 2;ada 5 1;bob 9 1;");
  EXPECT_EQ(lines("SELECT owner FROM turns WHERE turn >= 0"), "") << "nobody has had a turn";
}

TEST_F(DatabaseTest, TriggersCountWhatOwnersHave) {
  Database db(file(), Database::Mode::kReadWrite);
  migrate(db);
  db.execute("INSERT INTO artifact_kinds (name) VALUES ('lattice')");
  const std::string sha(64, 'a');
  db.run("INSERT INTO meshes (sha256, bytes, created_ms) VALUES (?, 3, 0)", sha);
  db.run(
      "INSERT INTO erosions (id, mesh_sha256, params, params_key) VALUES (1, ?1, x'', ''), (2, ?1, x'', 'k')",
      sha);
  db.run(
      "UPDATE erosions SET core_version = 'c', prepared = x'', points = 10, directions = 4, stride = 1 WHERE id = 1");
  db.run(
      "INSERT INTO artifacts (erosion_id, kind, params_key, bytes, sha256, items) VALUES (1, 'lattice', '', "
      "7, ?, 0)",
      sha);
  db.run(
      "INSERT INTO jobs (id, name, owner, priority, state, stage, erosion_id, skeleton, skeleton_key, "
      "created_ms)"
      " VALUES (printf('%032d', 1), 'n', 'ada', 5, 'running', 'erode', 1, x'', '', 0),"
      " (printf('%032d', 2), 'n', 'ada', 5, 'cancelled', 'erode', 1, x'', '', 0),"
      " (printf('%032d', 3), 'n', 'bob', 5, 'queued', 'prepare', 2, x'', '', 0)");
  const auto use = [&](const char* owner) {
    Statement row = db.query(
        "SELECT queued_jobs || ' ' || mesh_bytes || ' ' || stored_bytes FROM owner_use WHERE owner = ?",
        owner);
    return row.step() ? row.text(0) : std::string();
  };
  EXPECT_EQ(use("ada"), "1 3 210");
  EXPECT_EQ(use("bob"), "1 3 3");
  db.run("DELETE FROM jobs WHERE owner = 'ada'");
  EXPECT_EQ(use("ada"), "0 0 0");
}

TEST_F(DatabaseTest, KindsAreThoseOfTheirTables) {
  Database db(file(), Database::Mode::kReadWrite);
  migrate(db);
  const std::string sha(64, 'a');
  add_erosion(db, sha);
  const char* insert =
      "INSERT INTO artifacts (erosion_id, kind, params_key, bytes, sha256, items) VALUES (1, ?, '', 1, ?, 0)";
  EXPECT_THROW(db.run(insert, "medial-axis", sha), SqliteError);
  db.run("INSERT INTO artifact_kinds (name) VALUES ('medial-axis')");
  EXPECT_NO_THROW(db.run(insert, "medial-axis", sha));
}

TEST_F(DatabaseTest, RefusesNewerSchema) {
  Database db(file(), Database::Mode::kReadWrite);
  migrate(db);
  db.execute("PRAGMA user_version = 1000");
  EXPECT_STORE_ERROR(migrate(db), kUnusable);
}

TEST_F(DatabaseTest, RefusesForeignDatabase) {
  Database db(file(), Database::Mode::kReadWrite);
  db.execute("CREATE TABLE somebody_elses (x INTEGER)");
  EXPECT_STORE_ERROR(migrate(db), kUnusable);
}

TEST_F(DatabaseTest, StoredMeshCannotBeChanged) {
  Database db(file(), Database::Mode::kReadWrite);
  migrate(db);
  const std::string sha(64, 'a');
  db.run("INSERT INTO meshes (sha256, bytes, created_ms) VALUES (?, 3, 0)", sha);
  db.run("INSERT INTO mesh_chunks (sha256, idx, data) VALUES (?, 0, x'010203')", sha);
  EXPECT_THROW(db.run("UPDATE meshes SET bytes = 4"), SqliteError);
  EXPECT_THROW(db.run("UPDATE mesh_chunks SET data = x'00'"), SqliteError);
}

TEST_F(DatabaseTest, ChecksStates) {
  Database db(file(), Database::Mode::kReadWrite);
  migrate(db);
  const std::string sha(64, 'a');
  add_erosion(db, sha);
  const char* insert =
      "INSERT INTO jobs (id, name, owner, priority, state, stage, erosion_id, skeleton, skeleton_key, "
      "created_ms)"
      " VALUES (?, '', '', ?, ?, ?, ?, x'', '', 0)";
  const std::string id(32, '0');
  EXPECT_THROW(db.run(insert, id, 5, "sleeping", "prepare", 1), SqliteError);
  EXPECT_THROW(db.run(insert, id, 10, "queued", "prepare", 1), SqliteError);
  EXPECT_THROW(db.run(insert, id, 5, "done", "erode", 1), SqliteError);
  EXPECT_THROW(db.run(insert, id, 5, "queued", "prepare", 2), SqliteError);  // no such erosion
  EXPECT_NO_THROW(db.run(insert, id, 5, "queued", "prepare", 1));
}

}  // namespace
}  // namespace affskel::server
