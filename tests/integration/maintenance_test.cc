// Checks, copies and migrates the database of the real server, while it runs and while it does not.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "lab.h"

namespace affskel::integration {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKeptPoints = "100000";
constexpr const char* kKeptDirections = "triangles+sphere:8000";

// Small reports, so that the backup falls into the middle of the job; no lease ends by itself.
const std::vector<std::string> kOftenReports = {"--lease-ms", "60000", "--report-interval-ms", "50"};

class ServerCommandsTest : public testing::Test {
 protected:
  ServerCommandsTest() { lab_.make_torus(2048); }

  Output command(std::vector<std::string> arguments, const std::string& data_dir) const {
    arguments.insert(arguments.begin(), AFFSKEL_SERVER_BINARY);
    arguments.insert(arguments.end(), {"--data-dir", data_dir});
    return lab_.run(arguments);
  }
  Output check() const { return command({"check"}, lab_.path("data")); }

  static void expect_field(const Lab& lab, const std::string& id, const std::string& expected) {
    const v1::Job job = lab.follow_to_end(id);
    ASSERT_EQ(job.state(), v1::JOB_STATE_DONE) << job.error().message();
    const Output fetched = lab.client({"fetch", id, "field", "-o", lab.path("field.csv")});
    ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
    EXPECT_TRUE(lab.read("field.csv") == expected) << "the fields differ";
  }

  void run_sql(const std::string& script) const {
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(lab_.path("data/affskel.db").c_str(), &db), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(db, script.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
    sqlite3_close(db);
  }

  Lab lab_;
};

// Taken in mid run and put into an empty directory, it goes on there as the original does here.
TEST_F(ServerCommandsTest, ABackupTakenInMidRunGoesOnElsewhere) {
  const Output plain = lab_.run({AFFSKEL_WORKER_BINARY, "compute", lab_.path("m.off"), "--points",
                                 kKeptPoints, "--directions", kKeptDirections, "-o", lab_.path("plain.csv")});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  const std::string expected = lab_.read("plain.csv");

  const Process server = lab_.server(kOftenReports);
  const Process worker = lab_.worker();
  const std::string done = lab_.submit({"--points", "2000", "--wait"});
  const std::string id = lab_.submit({"--points", kKeptPoints, "--directions", kKeptDirections});
  const v1::Job acknowledged = lab_.follow_to_share(id, 0.3);
  ASSERT_EQ(acknowledged.state(), v1::JOB_STATE_RUNNING);
  const Output backup = command({"backup", "-o", lab_.path("copy.db")}, lab_.path("data"));
  ASSERT_EQ(backup.exit_code, 0) << backup.err;
  ASSERT_EQ(lab_.job(id).state(), v1::JOB_STATE_RUNNING) << "the job was over before the backup";
  const Output beside = check();
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_NE(beside.out.find("server: pid " + std::to_string(server.pid())), std::string::npos) << beside.out;

  const Lab other;
  fs::create_directory(other.path("data"));
  fs::copy_file(lab_.path("copy.db"), other.path("data/affskel.db"));
  const Output sound = command({"check"}, other.path("data"));
  EXPECT_EQ(sound.exit_code, 0) << sound.err;
  EXPECT_NE(sound.out.find("\nserver: none\n"), std::string::npos) << sound.out;
  const Process restored = other.server(kOftenReports);
  const v1::Job copy = other.job(id);
  EXPECT_GE(copy.directions_done(), acknowledged.directions_done()) << "acknowledged work is missing";
  EXPECT_LT(copy.directions_done(), copy.directions_total());
  EXPECT_EQ(other.job(done).state(), v1::JOB_STATE_DONE);
  const Process other_worker = other.worker();
  expect_field(other, id, expected);
  expect_field(lab_, id, expected);
}

// What a killed server had acknowledged may still be in the log alone.
TEST_F(ServerCommandsTest, AKilledServersDatabaseIsSoundAndCopiedWithItsLog) {
  Process server = lab_.server(kOftenReports);
  Process worker = lab_.worker();
  const std::string id = lab_.submit({"--points", kKeptPoints, "--directions", kKeptDirections});
  const v1::Job acknowledged = lab_.follow_to_share(id, 0.2);
  server.kill_hard();
  worker.kill_hard();
  const std::string before = lab_.read("data/affskel.db"), log = lab_.read("data/affskel.db-wal");
  ASSERT_FALSE(log.empty());

  const Output alone = check();
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_NE(alone.out.find("\nserver: none\n"), std::string::npos) << alone.out;
  const Output backup = command({"backup", "--output", lab_.path("copy.db")}, lab_.path("data"));
  ASSERT_EQ(backup.exit_code, 0) << backup.err;
  EXPECT_TRUE(lab_.read("data/affskel.db") == before) << "neither changes anything";
  EXPECT_TRUE(lab_.read("data/affskel.db-wal") == log);

  fs::remove_all(lab_.path("data"));
  fs::create_directory(lab_.path("data"));
  fs::rename(lab_.path("copy.db"), lab_.path("data/affskel.db"));
  server = lab_.server(kOftenReports);
  EXPECT_GE(lab_.job(id).directions_done(), acknowledged.directions_done());
}

TEST_F(ServerCommandsTest, PlantedFaultsAreFound) {
  Process server = lab_.server();
  const Process worker = lab_.worker();
  lab_.submit({"--points", "2000", "--wait"});
  server.send(SIGTERM);
  ASSERT_EQ(server.wait(), 0);
  ASSERT_EQ(check().exit_code, 0);
  run_sql("UPDATE erosions SET directions_done = directions_done - 1, finished = 0");
  const Output faulty = check();
  EXPECT_EQ(faulty.exit_code, 1);
  EXPECT_NE(faulty.err.find("are counted as done"), std::string::npos) << faulty.err;
  EXPECT_NE(faulty.out.find("\nsound: no\n"), std::string::npos) << faulty.out;
}

TEST_F(ServerCommandsTest, MigrateIsRefusedWhileTheServerRuns) {
  Process server = lab_.server();
  const Output refused = command({"migrate"}, lab_.path("data"));
  EXPECT_EQ(refused.exit_code, 7);
  EXPECT_NE(refused.err.find("pid " + std::to_string(server.pid())), std::string::npos) << refused.err;
  server.send(SIGTERM);
  ASSERT_EQ(server.wait(), 0);
  const Output done = command({"migrate"}, lab_.path("data"));
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.err.find("nothing to do"), std::string::npos) << done.err;
  fs::remove(lab_.path("data/affskel.db"));
  std::ifstream first(AFFSKEL_FIRST_MIGRATION);
  run_sql(std::string(std::istreambuf_iterator<char>(first), {}) +
          "PRAGMA application_id = 1095127883; PRAGMA user_version = 14");
  const Output old = check();
  EXPECT_EQ(old.exit_code, 0) << old.err;
  EXPECT_NE(old.err.find("affskel-server migrate"), std::string::npos) << old.err;
  const Output migrated = command({"migrate"}, lab_.path("data"));
  EXPECT_EQ(migrated.exit_code, 0) << migrated.err;
  EXPECT_NE(migrated.out.find("\nfrom: -1\nto: "), std::string::npos) << migrated.out;
  EXPECT_EQ(check().exit_code, 0);
}

TEST_F(ServerCommandsTest, AMissingFolderIsToldByTheExitCode) {
  const Process server = lab_.server();
  const Output missing = command({"backup", "-o", lab_.path("missing/copy.db")}, lab_.path("data"));
  EXPECT_EQ(missing.exit_code, 3);
}

TEST_F(ServerCommandsTest, AFullDiskIsToldByTheExitCode) {
  if (!lab_.can_mount()) GTEST_SKIP() << kCannotMount;
  const Process server = lab_.server();
  const Output full =
      lab_.run({"/usr/bin/unshare", "--user", "--map-root-user", "--mount", "/bin/sh", "-c",
                "mount -t tmpfs -o size=64k none \"$1\" && \"$2\" backup --data-dir \"$3\" -o \"$1/copy.db\";"
                " code=$?; ls -A \"$1\"; exit $code",
                "sh", lab_.path("disk"), AFFSKEL_SERVER_BINARY, lab_.path("data")});
  EXPECT_EQ(full.exit_code, 8) << full.err;
  EXPECT_EQ(full.out, "") << "nothing stays behind";
}

}  // namespace
}  // namespace affskel::integration
