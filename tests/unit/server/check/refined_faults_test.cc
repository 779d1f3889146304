// What check finds of a refinement, and how repair mends it.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

#include "check/check_database.h"
#include "check/repair.h"
#include "database/checksum.h"
#include "database/migrate.h"
#include "expect_store_error.h"
#include "refine_fixture.h"
#include "wire/params.h"
#include "wire/refined_record.h"

namespace affskel::server {
namespace {

class RefinedFaultsTest : public RefineTest {
 protected:
  std::string faults() {
    std::string text;
    check_database(directory_.path().string(),
                   [&](const Fault& fault) { text += fault.where + ": " + fault.what + "\n"; });
    return text;
  }

  void run(const char* script) {
    store_.reset();
    Database(database(), Database::Mode::kReadWrite).execute(script);
  }

  // Other bytes with the checksum that belongs to them.
  void replace(const char* table, const char* index, std::size_t at, const std::string& bytes) {
    store_.reset();
    Database db(database(), Database::Mode::kReadWrite);
    std::string data;
    std::int64_t row = 0, erosion = 0, place = 0;
    {
      const std::string sql =
          std::string("SELECT id, erosion_id, ") + index + ", data FROM " + table + " LIMIT 1";
      Statement first = db.query(sql.c_str());
      ASSERT_TRUE(first.step());
      row = first.integer(0);
      erosion = first.integer(1);
      place = first.integer(2);
      data = std::string(first.blob(3));
    }
    data.replace(at, bytes.size(), bytes);
    const bool log = std::string(table) == "refined_log";
    const std::string sql = std::string("UPDATE ") + table + " SET data = ?, sum = ? WHERE id = ?";
    db.run(sql.c_str(), Blob{data}, checksum(erosion, log ? -1 - place : place, data), row);
  }

  void flip(const char* table) {
    store_.reset();
    Database db(database(), Database::Mode::kReadWrite);
    BlobHandle blob(db, table, "data",
                    db.integer((std::string("SELECT min(id) FROM ") + table).c_str()).value());
    char byte = 0;
    blob.read(&byte, 1, 100);
    byte = static_cast<char>(byte ^ 0x10);
    blob.write(&byte, 1, 100);
  }

  int repair() {
    int actions = 0;
    repair_database(directory_.path().string(), [&](const std::string&) { ++actions; });
    return actions;
  }

  v1::Job finished_job() {
    const v1::Job job = erode_infimum();
    finish_rounds(job.id(), 4);
    derive();
    return job;
  }

  // Repaired, it begins the refinement anew, and gives the same field.
  void expect_mended(const std::string& job, const std::string& fault) {
    EXPECT_NE(faults().find(fault), std::string::npos) << faults();
    EXPECT_EQ(repair(), 1);
    EXPECT_EQ(faults(), "");
    open();
    EXPECT_EQ(store_->job(job).stage(), v1::JOB_STAGE_REFINE);
    EXPECT_EQ(store_->job(job).refine_round(), 0U);
    finish_rounds(job, 4);
    derive();
    EXPECT_TRUE(refined(job) == expected_refined(4));
    EXPECT_EQ(faults(), "");
  }
};

std::string bytes_of(double value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

TEST_F(RefinedFaultsTest, SoundAtEveryStep) {
  const v1::Job job = erode_infimum();
  EXPECT_EQ(faults(), "");
  for (int step = 0; store_->job(job.id()).stage() == v1::JOB_STAGE_REFINE; ++step) {
    const v1::Lease task = lease();
    const std::uint64_t begin = task.positions(0).begin(), end = task.positions(0).end();
    report_points(task, begin, (begin + end) / 2);
    if (step % 8 == 0) {
      EXPECT_EQ(faults(), "") << step;
    }
    report_points(task, (begin + end) / 2, end, true);
    if (step % 8 == 1) {
      EXPECT_EQ(faults(), "") << step;
    }
  }
  EXPECT_EQ(faults(), "");
  derive();
  EXPECT_EQ(faults(), "");
}

TEST_F(RefinedFaultsTest, AFlippedBitIsNotServed) {
  const v1::Job job = finished_job();
  flip("refined_chunks");
  open();
  EXPECT_STORE_ERROR(refined(job.id()), kDamaged);
  store_.reset();
  expect_mended(job.id(), "does not match its checksum");
}

TEST_F(RefinedFaultsTest, AMissingChunkIsNoticed) {
  const v1::Job job = finished_job();
  run("DELETE FROM refined_chunks WHERE idx = 1");
  expect_mended(job.id(), "refined chunk 1: is missing");
}

TEST_F(RefinedFaultsTest, AChunkMissingInRoundZeroIsNoticed) {
  const v1::Job job = erode_infimum();
  finish_points(lease());
  run("DELETE FROM refined_chunks");
  expect_mended(job.id(), "refined chunk 0: is missing");
}

TEST_F(RefinedFaultsTest, AValueThatNoReportCanHaveBroughtIsNoticed) {
  const v1::Job job = finished_job();
  replace("refined_chunks", "idx", 0, bytes_of(std::numeric_limits<double>::quiet_NaN()));
  expect_mended(job.id(), "point 0: E is");
}

TEST_F(RefinedFaultsTest, AValueAboveTheSetsIsNoticed) {
  const v1::Job job = finished_job();
  replace("refined_chunks", "idx", wire::kRefinedRecordBytes, bytes_of(15));
  expect_mended(job.id(), "point 1: E is above that of the set of directions");
}

TEST_F(RefinedFaultsTest, ADamagedLogEndsTheJobWithTheReason) {
  const v1::Job job = erode_infimum();
  finish_rounds(job.id(), 1);
  finish_points(lease());
  flip("refined_log");
  open();
  while (store_->job(job.id()).state() == v1::JOB_STATE_RUNNING) finish_points(lease());
  EXPECT_EQ(store_->job(job.id()).error().code(), "DAMAGED");
  store_.reset();
  expect_mended(job.id(), "of the refinement: does not match its checksum");
}

TEST_F(RefinedFaultsTest, LostBookkeepingIsNoticed) {
  const v1::Job job = erode_infimum();
  report_points(lease(), 0, 50);
  run("DELETE FROM refined_ranges");
  EXPECT_NE(faults().find("50 points are counted as refined, the ranges have 0"), std::string::npos)
      << faults();
  run("UPDATE erosions SET refined_points = 0; DELETE FROM tasks WHERE kind = 'refine'");
  EXPECT_NE(faults().find("its blocks of round 0 do not cover points 0 to 5000 once"), std::string::npos)
      << faults();
}

// A database of the schema before, with a job amid its work, goes on.
TEST_F(RefinedFaultsTest, ADatabaseOfTheSchemaBeforeIsTakenOver) {
  store_.reset();
  std::filesystem::remove(database());
  {
    Database db(database(), Database::Mode::kReadWrite);
    const std::vector<Migration>& all = embedded_migrations();
    ASSERT_EQ(migrate(db, {all.begin(), all.begin() + 2}), 2);
    v1::ErosionParams params;
    params.mutable_sampling()->set_spacing(0.25);
    params.set_directions("triangles");
    params.set_repair(true);
    params.set_frame(v1::FRAME_AXIS);
    const v1::SubmitJobHeader header = submit_header("OFF 1");
    const std::string bytes = params.SerializeAsString(),
                      skeleton = wire::canonical(header.skeleton()).SerializeAsString();
    db.run("INSERT INTO meshes VALUES (?, 5, 1)", header.mesh_sha256());
    db.run("INSERT INTO mesh_chunks VALUES (?, 0, ?)", header.mesh_sha256(), Blob{"OFF 1"});
    db.run(
        "INSERT INTO erosions (mesh_sha256, params, params_key) VALUES (?, ?, 'spacing=3fd0000000000000"
        " directions=triangles repair=1')",
        header.mesh_sha256(), Blob{bytes});
    db.run(
        "INSERT INTO jobs (id, name, owner, priority, state, stage, erosion_id, skeleton, skeleton_key, created_ms)"
        " VALUES (?, 'body', 'ada', 5, 'queued', 'prepare', 1, ?, ?, 1)",
        std::string(32, 'a'), Blob{skeleton}, wire::cache_key(wire::canonical(header.skeleton())));
    db.run("INSERT OR IGNORE INTO task_kinds VALUES ('prepare')");
    db.run(
        "INSERT INTO tasks (job_id, kind, state, seq, priority, owner) VALUES (?, 'prepare', 'pending', 1, 5, 'ada')",
        std::string(32, 'a'));
  }
  open();
  EXPECT_EQ(faults(), "");
  erode(20, 16);
  derive();
  EXPECT_EQ(store_->job(std::string(32, 'a')).state(), v1::JOB_STATE_DONE);
  EXPECT_TRUE(field(std::string(32, 'a')) == expected_field(20, 16));
  EXPECT_EQ(faults(), "");
  const v1::Job refining = erode_infimum();
  EXPECT_EQ(refining.stage(), v1::JOB_STAGE_REFINE);
  EXPECT_EQ(faults(), "");
}

}  // namespace
}  // namespace affskel::server
