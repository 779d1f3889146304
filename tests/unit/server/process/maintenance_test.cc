#include "process/maintenance.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "database/migrate.h"
#include "process/data_dir.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code;
  std::string out;
  std::string err;
};

Outcome run_it(const Options& options) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = run_maintenance(options);
  std::string out = testing::internal::GetCapturedStdout();
  return {code, std::move(out), testing::internal::GetCapturedStderr()};
}

std::int64_t ask(const std::string& file, const char* pragma) {
  Database db(file, Database::Mode::kReadOnly);
  return db.integer(pragma).value_or(-1);
}

class MaintenanceTest : public StoreTest {
 protected:
  Options options(Command command) const {
    Options result;
    result.command = command;
    result.data_dir = directory_.path().string();
    result.output = (elsewhere_.path() / "copy.db").string();
    return result;
  }

  void plant(const std::string& script) const {
    Database db(database(), Database::Mode::kReadWrite);
    db.execute(script);
  }

  /// With a signal that was sent and waits.
  static Outcome run_while_pending(int number, const Options& options) {
    sigset_t set;
    sigset_t before;
    sigemptyset(&set);
    sigaddset(&set, number);
    pthread_sigmask(SIG_BLOCK, &set, &before);
    pthread_kill(pthread_self(), number);
    Outcome outcome = run_it(options);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return outcome;
  }

  /// An empty database of the last program before 0.1.0 in the place of the store's.
  void make_earlier() {
    store_.reset();
    fs::remove(database());
    Database db(database(), Database::Mode::kReadWrite);
    migrate(db, {embedded_migrations().front()});
    db.execute("PRAGMA application_id = 1095127883; PRAGMA user_version = 14");
  }

  TemporaryDirectory elsewhere_;
};

TEST_F(MaintenanceTest, CheckTellsWhoServesAndThatAllIsSound) {
  const Outcome alone = run_it(options(Command::kCheck));
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_NE(alone.out.find("\nserver: none\n"), std::string::npos) << alone.out;
  EXPECT_NE(alone.out.find("\nsound: yes\n"), std::string::npos) << alone.out;
  EXPECT_EQ(alone.err, "");
  const DataDir held(directory_.path().string());
  const Outcome beside = run_it(options(Command::kCheck));
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_NE(beside.out.find("server: pid " + std::to_string(getpid()) + "\n"), std::string::npos)
      << beside.out;
}

TEST_F(MaintenanceTest, FaultsAreOnStderrAndTheExitCodeIsOne) {
  complete_job(300, 40);
  plant("UPDATE erosions SET directions_done = 39, finished = 0");
  const Outcome text = run_it(options(Command::kCheck));
  EXPECT_EQ(text.exit_code, 1);
  EXPECT_NE(text.err.find("affskel-server: erosion 1: 39 directions are counted"), std::string::npos)
      << text.err;
  EXPECT_NE(text.out.find("\nsound: no\n"), std::string::npos) << text.out;

  Options json = options(Command::kCheck);
  json.json = true;
  const Outcome document = run_it(json);
  EXPECT_EQ(document.exit_code, 1);
  const nlohmann::json result = nlohmann::json::parse(document.out);
  EXPECT_EQ(result["sound"], false);
  EXPECT_EQ(result["faults"], std::count(document.err.begin(), document.err.end(), '\n'));
  std::istringstream errors(document.err);
  for (std::string line; std::getline(errors, line);) {
    EXPECT_EQ(nlohmann::json::parse(line)["error"]["code"], "FAULT");
  }
}

TEST_F(MaintenanceTest, MissingForeignAndNewerDatabasesAreBadInput) {
  store_.reset();
  for (const Command command : {Command::kCheck, Command::kBackup, Command::kMigrate}) {
    Options missing = options(command);
    missing.data_dir = (elsewhere_.path() / "missing").string();
    EXPECT_EQ(run_it(missing).exit_code, 3);
    EXPECT_FALSE(fs::exists(missing.data_dir)) << "nothing is made";
  }
  plant("PRAGMA user_version = 1000");
  EXPECT_EQ(run_it(options(Command::kCheck)).exit_code, 3);
  EXPECT_EQ(run_it(options(Command::kMigrate)).exit_code, 3);
  std::ofstream(database(), std::ios::trunc) << std::string(4096, 'x');
  for (const Command command : {Command::kCheck, Command::kBackup, Command::kMigrate}) {
    const Outcome garbage = run_it(options(command));
    EXPECT_EQ(garbage.exit_code, 3);
    EXPECT_NE(garbage.err.find("affskel.db"), std::string::npos) << garbage.err;
  }
}

// SQLite deletes the log beside an empty database as soon as it opens it.
TEST_F(MaintenanceTest, AnEmptyDatabaseIsRefusedAndItsLogLeftAlone) {
  store_.reset();
  std::ofstream(database(), std::ios::trunc).flush();
  const std::string log = database() + "-wal";
  std::ofstream(log, std::ios::trunc) << "acknowledged";
  for (const Command command : {Command::kCheck, Command::kBackup, Command::kMigrate}) {
    const Outcome refused = run_it(options(command));
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_NE(refused.err.find("is empty"), std::string::npos) << refused.err;
    EXPECT_EQ(fs::file_size(log), 12U);
  }
}

TEST_F(MaintenanceTest, WhatARepairFailsAtIsNotForAnother) {
  store_.reset();
  fs::resize_file(database(), fs::file_size(database()) / 2);
  fs::remove(database() + "-wal");
  Options repair = options(Command::kCheck);
  EXPECT_NE(run_it(repair).err.find("check --repair, or restore a backup"), std::string::npos);
  repair.repair = true;
  const Outcome failed = run_it(repair);
  EXPECT_NE(failed.exit_code, 0);
  EXPECT_EQ(failed.err.find("check --repair"), std::string::npos) << failed.err;
  EXPECT_NE(failed.err.find("restore a backup"), std::string::npos) << failed.err;
}

TEST_F(MaintenanceTest, AnIgnoredSignalDoesNotEndABackup) {
  const auto handler = signal(SIGHUP, SIG_IGN);
  const Outcome done = run_while_pending(SIGHUP, options(Command::kBackup));
  signal(SIGHUP, handler);
  EXPECT_EQ(done.exit_code, 0) << done.err;
}

TEST_F(MaintenanceTest, BackupSaysWhereAndHowLarge) {
  const Outcome done = run_it(options(Command::kBackup));
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.out.find("\nbytes: " + std::to_string(fs::file_size(elsewhere_.path() / "copy.db"))),
            std::string::npos)
      << done.out;
  const Outcome again = run_it(options(Command::kBackup));
  EXPECT_EQ(again.exit_code, 7);
  EXPECT_NE(again.err.find("--force"), std::string::npos) << again.err;
  Options elsewhere = options(Command::kBackup);
  elsewhere.output = (elsewhere_.path() / "missing" / "copy.db").string();
  elsewhere.json = true;
  const Outcome refused = run_it(elsewhere);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(nlohmann::json::parse(refused.err)["error"]["code"], "BAD_INPUT");
}

TEST_F(MaintenanceTest, ASignalEndsABackupWithNothingWritten) {
  const Outcome interrupted = run_while_pending(SIGTERM, options(Command::kBackup));
  EXPECT_EQ(interrupted.exit_code, 6);
  EXPECT_TRUE(fs::is_empty(elsewhere_.path()));
}

TEST_F(MaintenanceTest, MigrateBringsAnOldDatabaseUpToDate) {
  make_earlier();
  const Outcome old = run_it(options(Command::kCheck));
  EXPECT_EQ(old.exit_code, 0) << old.err;
  EXPECT_NE(old.err.find("affskel-server migrate"), std::string::npos) << old.err;
  EXPECT_NE(old.out.find("\ncomplete: no\n"), std::string::npos) << old.out;
  const Outcome done = run_it(options(Command::kMigrate));
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::string newest = std::to_string(newest_schema());
  EXPECT_NE(done.out.find("\nfrom: -1\nto: " + newest + "\n"), std::string::npos) << done.out;
  EXPECT_EQ(ask(database(), "PRAGMA user_version"), newest_schema());
  const Outcome again = run_it(options(Command::kMigrate));
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.out.find("\nfrom: " + newest + "\nto: " + newest + "\n"), std::string::npos) << again.out;
}

TEST_F(MaintenanceTest, MigrateIsRefusedWhileAServerRuns) {
  make_earlier();
  const DataDir server(directory_.path().string());
  const Outcome refused = run_it(options(Command::kMigrate));
  EXPECT_EQ(refused.exit_code, 7);
  EXPECT_NE(refused.err.find("pid " + std::to_string(getpid())), std::string::npos) << refused.err;
  EXPECT_EQ(ask(database(), "PRAGMA user_version"), 14);
}

TEST_F(MaintenanceTest, MigrateLeavesForeignDatabasesAsTheyAre) {
  store_.reset();
  plant("PRAGMA application_id = 7; PRAGMA journal_mode = DELETE");
  const auto written = fs::last_write_time(database());
  EXPECT_EQ(run_it(options(Command::kMigrate)).exit_code, 3);
  EXPECT_EQ(fs::last_write_time(database()), written);
}

}  // namespace
}  // namespace affskel::server
