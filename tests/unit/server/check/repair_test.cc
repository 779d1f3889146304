#include "check/repair.h"

#include <fstream>

#include "check/check_database.h"
#include "database/database_file.h"
#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

constexpr std::uint32_t kRepairedPoints = 9000;  // three chunks
constexpr std::uint32_t kRepairedDirections = 64;

class RepairTest : public StoreTest {
 protected:
  /// Closes the database, damages it, and returns what is wrong.
  void damage(const char* script) {
    store_.reset();
    Database db(database(), Database::Mode::kReadWrite);
    db.execute("PRAGMA ignore_check_constraints = ON");
    db.execute(script);
  }

  void flip(const char* table, const char* where) {
    store_.reset();
    Database db(database(), Database::Mode::kReadWrite);
    const std::string query = std::string("SELECT rowid FROM ") + table + " WHERE " + where;
    BlobHandle blob(db, table, "data", db.integer(query.c_str()).value());
    char byte = 0;
    blob.read(&byte, 1, blob.size() / 2);
    byte = static_cast<char>(byte ^ 0x10);
    blob.write(&byte, 1, blob.size() / 2);
  }

  std::string faults() {
    std::string text;
    check_database(directory_.path().string(),
                   [&](const Fault& fault) { text += fault.where + ": " + fault.what + "\n"; });
    return text;
  }

  int repair() {
    int actions = 0;
    repair_database(directory_.path().string(), [&](const std::string&) { ++actions; });
    return actions;
  }

  void erode_again() {
    for (v1::Lease block = lease();; block = lease()) {
      if (block.kind() != v1::TASK_KIND_ERODE) {
        store_->give_back(block.token());
        return;
      }
      finish_block(block);
    }
  }
};

TEST_F(RepairTest, ASoundDatabaseStaysAsItIs) {
  const v1::Job job = complete_job(kRepairedPoints, kRepairedDirections);
  store_.reset();
  EXPECT_EQ(repair(), 0);
  open();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
}

// No result with a flipped bit is ever given out; repaired, the same job gives the same field.
TEST_F(RepairTest, AFlippedBitOfAFieldIsNotServedAndIsComputedAgain) {
  const v1::Job job = complete_job(kRepairedPoints, kRepairedDirections);
  flip("field_chunks", "idx = 1");
  EXPECT_NE(faults().find("all 64 finished directions of 64 must be computed again"), std::string::npos);
  open();
  EXPECT_STORE_ERROR(field(job.id()), kDamaged);
  store_.reset();
  EXPECT_EQ(repair(), 1);
  EXPECT_EQ(faults(), "");
  open();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(store_->job(job.id()).directions_done(), 0U);
  erode_again();
  derive();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(field(job.id()), expected_field(kRepairedPoints, kRepairedDirections));
  store_.reset();
  EXPECT_EQ(faults(), "");
}

TEST_F(RepairTest, JobsThatSharedADamagedFieldGetItAgain) {
  const v1::Job one = complete_job(kRepairedPoints, kRepairedDirections, "one");
  const v1::Job two = submit("OFF 1", "two");
  ASSERT_EQ(store_->job(two.id()).state(), v1::JOB_STATE_DONE);
  flip("field_chunks", "idx = 0");
  EXPECT_EQ(repair(), 1);
  EXPECT_EQ(faults(), "");
  open();
  erode_again();
  derive();
  while (has_work()) derive();
  EXPECT_EQ(store_->job(one.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(store_->job(two.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(field(two.id()), expected_field(kRepairedPoints, kRepairedDirections));
}

// A report that meets the damage is refused, its job fails with the reason, and others go on.
TEST_F(RepairTest, AReportIntoADamagedFieldFailsItsJobAlone) {
  const v1::Job job = submit();
  prepare(kRepairedPoints, kRepairedDirections);
  finish_block(lease());
  finish_block(lease());
  store_.reset();
  {
    Database db(database(), Database::Mode::kReadWrite);
    ASSERT_GT(db.integer("SELECT count(*) FROM field_log").value() +
                  db.integer("SELECT count(*) FROM field_chunks").value(),
              0);
    db.execute("UPDATE field_log SET sum = sum + 1; UPDATE field_sums SET sum = sum + 1");
  }
  open();
  const v1::Job other = submit("OFF 2", "other");
  bool refused = false;
  for (int i = 0; i < 10 && !refused; ++i) {
    try {
      finish_block(lease());
    } catch (const StoreError& error) {
      refused = error.code() == StoreError::Code::kDamaged;
    }
    refused = refused || store_->job(job.id()).state() == v1::JOB_STATE_FAILED;
  }
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(store_->job(job.id()).error().code(), "DAMAGED");
  EXPECT_NE(store_->job(job.id()).error().message().find("check --repair"), std::string::npos);
  EXPECT_EQ(lease().job().id(), other.id());
  store_.reset();
  EXPECT_EQ(repair(), 1);
  EXPECT_EQ(faults(), "");
  open();
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_QUEUED);
}

TEST_F(RepairTest, ADamagedMeshFailsItsJobAndIsMendedByTheSameFile) {
  const v1::Job job = submit("OFF damaged", "job");
  flip("mesh_chunks", "1");
  open();
  const v1::Lease prepare = lease();
  const auto reader = store_->open_input(prepare.token(), v1::ARTIFACT_KIND_MESH);
  EXPECT_STORE_ERROR(read_all(*reader), kDamaged);
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(store_->job(job.id()).error().code(), "DAMAGED");
  EXPECT_NE(store_->job(job.id()).error().message().find("submit the same file again"), std::string::npos);
  store_.reset();
  EXPECT_EQ(repair(), 0);
  EXPECT_NE(faults().find("submit the same file again"), std::string::npos);
  open();
  submit("OFF damaged", "job");
  store_.reset();
  EXPECT_EQ(faults(), "");
}

TEST_F(RepairTest, DerivedArtefactsAreMadeAgain) {
  const v1::Job job = complete_job(kRepairedPoints, kRepairedDirections);
  flip("artifact_chunks", "length(data) = 8");
  open();
  v1::FetchArtifactRequest request = artifact_request(job.id(), v1::ARTIFACT_KIND_SKELETON);
  EXPECT_STORE_ERROR(read_all(*store_->open_artifact(request).reader), kDamaged);
  store_.reset();
  EXPECT_EQ(repair(), 1);
  EXPECT_EQ(faults(), "");
  open();
  derive();
  EXPECT_EQ(read_all(*store_->open_artifact(request).reader), "skeleton");
}

TEST_F(RepairTest, AJobsOwnSheetIsMadeAgain) {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  const std::string id = store_->submit(header, "OFF 1").job.id();
  erode(kRepairedPoints, kRepairedDirections);
  derive("a sheet!");
  store_.reset();
  EXPECT_EQ(faults(), "");
  flip("artifact_chunks", "length(data) = 8");
  EXPECT_EQ(repair(), 1);
  EXPECT_EQ(faults(), "");
  open();
  EXPECT_EQ(store_->job(id).state(), v1::JOB_STATE_QUEUED) << "it is not done without its skeleton";
  derive("a sheet!");
  EXPECT_EQ(store_->job(id).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(read_all(*store_->open_artifact(artifact_request(id, v1::ARTIFACT_KIND_SURFACE)).reader),
            "a sheet!");
}

// Clients alone use the lattice: the field is kept, and the lattice made on request.
TEST_F(RepairTest, ALostLatticeIsMadeOnRequest) {
  const v1::Job job = complete_job(kRepairedPoints, kRepairedDirections);
  v1::FetchArtifactRequest request = artifact_request(job.id(), v1::ARTIFACT_KIND_LATTICE);
  const std::string lattice = read_all(*store_->open_artifact(request).reader);
  flip("artifact_chunks", "artifact_id = (SELECT id FROM artifacts WHERE kind = 'lattice')");
  EXPECT_EQ(repair(), 1);
  EXPECT_EQ(faults(), "");
  open();
  const Store::ArtifactState asked = store_->open_artifact(request);
  ASSERT_EQ(asked.reader, nullptr);
  EXPECT_FALSE(store_->lease(worker_identity("other", "2"), "", false)) << "of another core version";
  const v1::Lease task = lease();
  ASSERT_EQ(task.kind(), v1::TASK_KIND_PREPARE);
  PrepareResult wrong = prepare_result(task.token(), kRepairedPoints + 1, kRepairedDirections);
  EXPECT_STORE_ERROR(store_->complete(wrong.header, wrong.data), kInvalid);
  const PrepareResult right = prepare_result(task.token(), kRepairedPoints, kRepairedDirections);
  store_->complete(right.header, right.data);
  EXPECT_EQ(read_all(*store_->open_artifact(request, asked.task).reader), lattice);
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
  store_.reset();
  EXPECT_EQ(faults(), "");
}

// A worker that goes on as if nothing had happened would take for known what is not any more.
TEST_F(RepairTest, LeasesAndHeldFieldsEndWithARepairAndWithACopyPutBack) {
  submit();
  prepare(kRepairedPoints, kRepairedDirections);
  const v1::Lease before = lease(), late = lease("late");
  clock_.advance(options_.lease_ms + 1);
  store_->expire_leases();
  EXPECT_NO_THROW(store_->renew(before.token()));
  open();
  EXPECT_NO_THROW(store_->renew(before.token())) << "a restart alone ends no lease";
  store_.reset();
  const std::filesystem::path copy = database() + ".copy";
  std::filesystem::copy(database(), copy);
  std::filesystem::rename(copy, database());
  open();
  EXPECT_STORE_ERROR(store_->renew(before.token()), kFenced);
  EXPECT_STORE_ERROR(store_->renew(late.token()), kFenced);
  const v1::Lease after = lease();
  EXPECT_EQ(after.positions(0).begin(), before.positions(0).begin());
  EXPECT_NE(after.field(), before.field());
}

// Neither number nor birth of the file tell of it, nor would they where a whole volume is set back.
TEST_F(RepairTest, HeldFieldsEndWithACopyWrittenOverTheDatabase) {
  submit();
  prepare(kRepairedPoints, kRepairedDirections);
  const v1::Lease before = lease();
  store_.reset();
  const std::string copy = database() + ".copy";
  std::filesystem::copy_file(database(), copy);
  open();
  report(before, before.positions(0).begin(), before.positions(0).begin() + 1);
  store_.reset();
  std::ofstream(database(), std::ios::binary) << std::ifstream(copy, std::ios::binary).rdbuf();
  open();
  store_->give_back(before.token());
  const v1::Lease after = lease();
  EXPECT_EQ(after.positions(0).begin(), before.positions(0).begin()) << "its report is forgotten";
  EXPECT_NE(after.field(), before.field());
}

// The database file itself

TEST_F(RepairTest, AMissingOrEmptyDatabaseIsNotBegunAnew) {
  store_.reset();
  const std::string kept = database() + ".kept";
  std::filesystem::rename(database(), kept);
  EXPECT_STORE_ERROR(open(), kUnusable);
  EXPECT_FALSE(std::filesystem::exists(database()));
  std::ofstream(database()) << "";
  EXPECT_STORE_ERROR(open(), kUnusable);
  std::ofstream(database()) << "x";
  EXPECT_STORE_ERROR(open(), kUnusable);
  EXPECT_STORE_ERROR(faults(), kUnusable);
  std::filesystem::remove(database());
  Database(database(), Database::Mode::kReadWrite).execute("CREATE TABLE t (x); DROP TABLE t");
  EXPECT_STORE_ERROR(open(), kUnusable);
  for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(database() + suffix);
  std::filesystem::rename(kept, database());
  EXPECT_NO_THROW(open());
}

TEST_F(RepairTest, AMissingDatabaseWithALogIsNotBegunAnew) {
  store_.reset();
  std::filesystem::remove(database());
  std::filesystem::remove(directory_.path() / "affskel.made");
  std::ofstream(database() + "-wal") << "log";
  EXPECT_STORE_ERROR(open(), kUnusable);
  EXPECT_TRUE(std::filesystem::exists(database() + "-wal"));
}

TEST_F(RepairTest, NothingIsAcknowledgedOnceTheDatabaseWasRemoved) {
  submit();
  EXPECT_FALSE(store_->lost());
  std::filesystem::rename(database(), database() + ".away");
  EXPECT_TRUE(store_->lost());
  EXPECT_STORE_ERROR(submit("OFF 2", "two"), kLost);
  std::filesystem::rename(database() + ".away", database());
  EXPECT_FALSE(store_->lost());
  std::filesystem::rename(database() + "-wal", database() + "-wal.away");
  EXPECT_STORE_ERROR(submit("OFF 3", "three"), kLost);
}

}  // namespace
}  // namespace affskel::server
