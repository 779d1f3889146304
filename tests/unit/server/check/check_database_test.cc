#include "check/check_database.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <ostream>

#include "database/migrate.h"
#include "expect_store_error.h"
#include "store_fixture.h"
#include "wire/limits.h"

namespace affskel::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kPoints = 5000;  // two chunks of a field
constexpr std::uint32_t kDirections = 100;

std::vector<Fault> faults_of(const fs::path& data_dir) {
  std::vector<Fault> faults;
  const CheckResult result = check_database(data_dir, [&](const Fault& fault) { faults.push_back(fault); });
  EXPECT_EQ(result.faults, static_cast<std::int64_t>(faults.size()));
  return faults;
}

std::string text_of(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += fault.where + ": " + fault.what + "\n";
  return text;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A database with a job in every stage.
class CheckDatabaseTest : public StoreTest {
 protected:
  CheckDatabaseTest() {
    // Cancelled meanwhile, so that the others are next.
    const v1::Job eroding = submit("OFF eroding", "eroding");
    prepare(kPoints, kDirections);
    finish_block(lease());
    const v1::Lease half = lease();
    report(half, half.positions(0).begin(), half.positions(0).begin() + 2);
    log_one_record(half, half.positions(0).begin() + 2);
    store_->give_back(half.token());
    store_->cancel(eroding.id());
    complete_job(kPoints, kDirections, "done");
    submit("OFF deriving", "deriving");
    erode(kPoints, kDirections);
    submit("OFF queued", "queued");
    store_->resume(eroding.id());
  }

  void log_one_record(const v1::Lease& lease, std::uint64_t position) {
    v1::PositionRange range;
    range.set_begin(position);
    range.set_end(position + 1);
    v1::FieldRecords records;
    records.add_point(1);
    records.add_direction(0);
    records.add_erosion(0.25);
    records.add_area(1);
    report(lease, {range}, records, false);
  }

  const fs::path& data_dir() const { return directory_.path(); }
};

TEST_F(CheckDatabaseTest, SoundBesideTheServerAndWithoutOne) {
  EXPECT_EQ(text_of(faults_of(data_dir())), "");
  store_.reset();
  const std::string before = bytes_of(database());
  CheckResult result = check_database(data_dir(), [](const Fault&) {});
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.schema, newest_schema());
  EXPECT_EQ(result.jobs, 4);
  EXPECT_EQ(result.meshes, 4);
  EXPECT_EQ(result.fields, 2);
  EXPECT_EQ(result.artifacts, 7);
  EXPECT_EQ(result.faults, 0);
  EXPECT_TRUE(bytes_of(database()) == before) << "checking changes nothing";
}

// What a crash has left in the log belongs to the database, and stays there.
TEST_F(CheckDatabaseTest, ReadsTheLogAndLeavesIt) {
  const TemporaryDirectory crashed;
  for (const char* name : {"affskel.db", "affskel.db-wal"}) {
    fs::copy_file(data_dir() / name, crashed.path() / name);
  }
  const std::string log = bytes_of(crashed.path() / "affskel.db-wal");
  ASSERT_FALSE(log.empty());
  EXPECT_EQ(check_database(crashed.path(), [](const Fault&) {}).jobs, 4);
  EXPECT_TRUE(bytes_of(crashed.path() / "affskel.db-wal") == log);
}

// Rows that deleted jobs have left are no faults, however much of them is gone already.
TEST_F(CheckDatabaseTest, SoundAtEveryStepOfDeleting) {
  for (const char* name : {"eroding", "deriving", "queued"}) {
    for (const v1::Job& job : store_->list({}).jobs) {
      if (job.name() != name) continue;
      store_->cancel(job.id());
      store_->remove(job.id());
    }
  }
  do {
    EXPECT_EQ(text_of(faults_of(data_dir())), "");
  } while (store_->tidy());
  EXPECT_EQ(text_of(faults_of(data_dir())), "");
}

TEST_F(CheckDatabaseTest, SoundWhileLeasedFailedAndRequested) {
  v1::FetchArtifactRequest request;
  request.set_kind(v1::ARTIFACT_KIND_SURFACE);
  for (const v1::Job& job : store_->list({}).jobs) {
    if (job.name() == "done") request.set_job(job.id());
  }
  store_->open_artifact(request);
  v1::JobError error;
  error.set_code("BAD_INPUT");
  store_->fail(lease().token(), error, false);
  EXPECT_EQ(text_of(faults_of(data_dir())), "") << "a request has failed";
  while (const std::optional<v1::Lease> task = store_->lease(worker_identity(), "", false)) {
    EXPECT_EQ(text_of(faults_of(data_dir())), "") << "a task is leased";
    store_->fail(task->token(), error, false);
    EXPECT_EQ(text_of(faults_of(data_dir())), "") << "a job has failed";
  }
}

TEST_F(CheckDatabaseTest, TellsTheFirstOfAKindAndHowManyMore) {
  store_.reset();
  {
    Database db(database(), Database::Mode::kReadWrite);
    db.execute("UPDATE tasks SET state = 'pending', token = NULL WHERE kind = 'erode' AND state = 'done'");
  }
  std::vector<Fault> told;
  const CheckResult result = check_database(data_dir(), [&](const Fault& f) { told.push_back(f); }, {2});
  ASSERT_GT(result.faults, 3);
  ASSERT_EQ(told.size(), 3U);
  EXPECT_EQ(told[2].what, std::to_string(result.faults - 2) + " more of this kind");
}

TEST_F(CheckDatabaseTest, AFileThatIsCutOffIsFaulty) {
  store_.reset();
  fs::resize_file(database(), fs::file_size(database()) / 2);
  EXPECT_NE(text_of(faults_of(data_dir())), "");
}

TEST_F(CheckDatabaseTest, OverwrittenPagesAreFaulty) {
  store_.reset();
  std::int64_t page = 0;
  {
    Database db(database(), Database::Mode::kReadOnly);
    page = db.integer("SELECT rootpage FROM sqlite_schema WHERE name = 'jobs'").value();
  }
  {
    std::fstream file(database(), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp((page - 1) * 16384);
    file << std::string(12000, '\xa5');
  }
  EXPECT_NE(text_of(faults_of(data_dir())).find("database: "), std::string::npos);
}

TEST_F(CheckDatabaseTest, RefusesWhatIsNotOurs) {
  const TemporaryDirectory other;
  EXPECT_STORE_ERROR(faults_of(other.path()), kUnusable);
  EXPECT_STORE_ERROR(faults_of(other.path() / "missing"), kUnusable);
  {
    Database db((other.path() / "affskel.db").string(), Database::Mode::kReadWrite);
    db.execute("CREATE TABLE t (x INTEGER)");
  }
  EXPECT_STORE_ERROR(faults_of(other.path()), kUnusable);
  store_.reset();
  {
    Database db(database(), Database::Mode::kReadWrite);
    db.execute("PRAGMA user_version = " + std::to_string(newest_schema() + 1));
  }
  EXPECT_STORE_ERROR(faults_of(data_dir()), kUnusable);
}

TEST(CheckOldDatabaseTest, OnlySqlitesOwnChecksOfAnOlderSchema) {
  const TemporaryDirectory directory;
  {
    Database db((directory.path() / "affskel.db").string(), Database::Mode::kReadWrite);
    migrate(db, {embedded_migrations().front()});
    db.execute(
        "PRAGMA foreign_keys = OFF; INSERT INTO requests VALUES ('r', '', 'nobody');"
        "PRAGMA application_id = 1095127883; PRAGMA user_version = 14");
  }
  std::vector<Fault> faults;
  const CheckResult result =
      check_database(directory.path(), [&](const Fault& fault) { faults.push_back(fault); });
  EXPECT_EQ(result.schema, kBeforeFirst);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(text_of(faults), "table requests: a row refers to a row of jobs that is missing\n");
}

// Every kind of fault

struct Planted {
  const char* name;
  std::function<void(Database&)> plant;
  const char* found;  // words that only this kind of fault is told with
};

// Without it GoogleTest puts the bytes, addresses and all, into the names of the tests.
void PrintTo(const Planted& planted, std::ostream* out) {
  *out << planted.name;
}

/// SQL, in which EROSION(job) is the erosion of a job of that name and JOB(job) its id.
std::function<void(Database&)> sql(std::string script) {
  for (const char* job : {"eroding", "done", "deriving", "queued"}) {
    const std::string name = job;
    for (const auto& [word, column] : {std::pair("EROSION(", "erosion_id"), std::pair("JOB(", "id")}) {
      const std::string from = word + name + ")";
      for (std::size_t at; (at = script.find(from)) != std::string::npos;) {
        script.replace(at, from.size(),
                       std::string("(SELECT ") + column + " FROM jobs WHERE name = '" + name + "')");
      }
    }
  }
  return [script](Database& db) { db.execute(script); };
}

/// What a program with a bug would have stored: the bytes have their checksum.
void sign_fields(Database& db) {
  db.execute(
      "UPDATE field_sums SET sum = (SELECT checksum(erosion_id, idx, data) FROM field_chunks c"
      " WHERE c.erosion_id = field_sums.erosion_id AND c.idx = field_sums.idx);"
      " UPDATE field_log SET sum = checksum(erosion_id, -1, data)");
}

/// Overwrites the record of the field's first point.
std::function<void(Database&)> record(const char* job, double erosion, double area, std::uint32_t direction) {
  return [=](Database& db) {
    const std::optional<std::int64_t> row = db.integer(
        "SELECT c.id FROM field_chunks c JOIN jobs j ON j.erosion_id = c.erosion_id"
        " WHERE c.idx = 0 AND j.name = ?",
        job);
    BlobHandle blob(db, "field_chunks", "data", row.value());
    blob.write(&erosion, 8, 0);
    blob.write(&area, 8, 8);
    blob.write(&direction, 4, 16);
    sign_fields(db);
  };
}

/// Flips the lowest bit of a byte of the first row's data.
std::function<void(Database&)> flipped(const char* table, int offset) {
  return [=](Database& db) {
    BlobHandle blob(db, table, "data", 1);
    char byte = 0;
    blob.read(&byte, 1, offset);
    byte = static_cast<char>(byte ^ 1);
    blob.write(&byte, 1, offset);
  };
}

std::function<void(Database&)> logged(wire::PointRecord record) {
  return [=](Database& db) {
    const std::string_view bytes(reinterpret_cast<const char*>(&record), sizeof record);
    db.run("UPDATE field_log SET data = ?", Blob{bytes});
    sign_fields(db);
  };
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const Planted kPlanted[] = {
    {"CheckConstraint", sql("UPDATE jobs SET priority = 12"), "CHECK constraint failed in jobs"},
    {"Reference", sql("INSERT INTO requests VALUES ('r', '', 'nobody')"), "refers to a row of jobs"},
    {"Table", sql("DROP TABLE field_log"), "table field_log: is missing"},
    {"Column", sql("ALTER TABLE jobs DROP COLUMN quality"), "column jobs.quality: is missing"},
    {"ForeignTable", sql("CREATE TABLE notes (text TEXT)"), "table notes: is none of this program's"},
    {"ForeignTrigger", sql("CREATE TRIGGER fast AFTER INSERT ON jobs BEGIN SELECT 1; END"),
     "trigger fast: is none of this program's"},
    {"Index", sql("DROP INDEX jobs_by_state"), "index jobs_by_state: is missing"},
    {"Trigger", sql("DROP TRIGGER IF EXISTS meshes_are_immutable"),
     "trigger meshes_are_immutable: is missing"},
    // Rules
    {"DroppedErosionInUse", sql("UPDATE erosions SET dropped = 1 WHERE id = EROSION(done)"),
     "is marked for deletion, but job"},
    {"ForgottenErosion",
     sql("DELETE FROM tasks WHERE job_id = JOB(done); DELETE FROM jobs WHERE name = 'done'"),
     "no job needs it"},
    {"DroppedMeshInUse", sql("INSERT INTO dropped_meshes SELECT sha256 FROM meshes LIMIT 1"),
     "is marked for deletion, but erosion"},
    {"ForgottenMesh", sql("INSERT INTO meshes SELECT printf('%064d', 0), 1, 0"), "nothing needs it"},
    {"SharedUnfinished", sql("UPDATE jobs SET erosion_id = EROSION(eroding) WHERE name = 'queued'"),
     "is not finished, but 2 jobs share it"},
    {"Count", sql("UPDATE erosions SET directions_done = directions_done - 1 WHERE id = EROSION(eroding)"),
     "directions are counted as done, the ranges have"},
    {"Range", sql("UPDATE done_ranges SET end_position = 1000 WHERE erosion_id = EROSION(eroding)"),
     "positions up to 1000 are done, of 100"},
    {"Overlap", sql("INSERT INTO done_ranges VALUES (EROSION(eroding), 5, 7)"),
     "that begins at 5 is not apart"},
    {"Unprepared", sql("UPDATE field_log SET erosion_id = EROSION(queued)"),
     "is not prepared, but has a field"},
    {"Unmerged", sql("UPDATE field_log SET erosion_id = EROSION(done)"), "not all of its field is merged"},
    {"EarlyArtefact", sql("UPDATE artifacts SET erosion_id = EROSION(eroding) WHERE kind = 'skeleton'"),
     "a skeleton of erosion 1, which is not finished"},
    {"StageTooEarly", sql("UPDATE jobs SET stage = 'prepare' WHERE name = 'eroding'"),
     "is in stage prepare, its erosion is prepared and not finished"},
    {"StageTooLate", sql("UPDATE jobs SET stage = 'erode' WHERE name = 'queued'"),
     "is in stage erode, its erosion is not prepared"},
    {"StageBehind", sql("UPDATE jobs SET stage = 'erode' WHERE name = 'deriving'"),
     "is in stage erode, its erosion is finished"},
    {"NoSkeleton", sql("UPDATE artifacts SET params_key = 'x' WHERE kind = 'skeleton'"),
     "its skeleton is missing"},
    {"SkeletonPoints", sql("UPDATE jobs SET skeleton_points = 4 WHERE name = 'done'"),
     "tells of 4 skeleton points, its skeleton has 3"},
    {"Cancel", sql("UPDATE jobs SET cancel_requested = 1 WHERE name = 'done'"), "is done, but still to be"},
    {"NoPrepareTask", sql("DELETE FROM tasks WHERE job_id = JOB(queued)"), "no task is left to prepare it"},
    {"NoSkeletonTask", sql("UPDATE tasks SET state = 'done' WHERE kind = 'skeleton'"),
     "no task is left to make its skeleton"},
    {"FirstBlock", sql("DELETE FROM tasks WHERE job_id = JOB(eroding) AND first_position = 0"),
     "do not cover positions 0 to 100"},
    {"LastBlock", sql("DELETE FROM tasks WHERE job_id = JOB(eroding) AND end_position = 100"),
     "do not cover"},
    {"MiddleBlock",
     sql("UPDATE tasks SET end_position = end_position - 1 WHERE job_id = JOB(eroding) AND first_position = "
         "0"),
     "do not cover"},
    {"NotedMeshBytes", sql("UPDATE erosions SET mesh_bytes = mesh_bytes + 1"), "bytes of mesh noted"},
    {"AllBlocks", sql("DELETE FROM tasks WHERE job_id = JOB(eroding)"), "do not cover"},
    {"BlockDone", sql("UPDATE tasks SET state = 'done' WHERE job_id = JOB(eroding)"),
     "is done, but not all of its positions are"},
    {"BlockOpen", sql("UPDATE tasks SET state = 'pending', token = NULL WHERE kind = 'erode'"),
     "a task to erode job"},
    {"PrepareOpen", sql("UPDATE tasks SET state = 'pending', token = NULL WHERE kind = 'prepare'"),
     "a task to prepare job"},
    {"EarlyRequest", sql("UPDATE tasks SET job_id = JOB(eroding) WHERE kind = 'skeleton'"),
     "whose field is not finished"},
    {"FailedAlone", sql("UPDATE tasks SET state = 'failed', error_code = 'X' WHERE job_id = JOB(queued)"),
     "has failed alone"},
    // Contents
    {"MeshBytes", sql("UPDATE mesh_chunks SET data = x'4f4646'"), "bytes, recorded are"},
    {"MeshHash", sql("UPDATE mesh_chunks SET data = CAST(replace(data, 'OFF', 'off') AS BLOB)"),
     "has the SHA-256"},
    {"MeshPiece", sql("UPDATE mesh_chunks SET idx = 1"), "piece 0 is missing"},
    {"ArtefactBytes", sql("UPDATE artifacts SET bytes = bytes + 1 WHERE kind = 'skeleton'"),
     "has 8 bytes, recorded are 9"},
    {"ArtefactHash", sql("UPDATE artifact_chunks SET data = CAST('eletonsk' AS BLOB) WHERE length(data) = 8"),
     "(skeleton of erosion 2): has the SHA-256"},
    {"ArtefactPiece", sql("DELETE FROM artifact_chunks"), "has 0 bytes, recorded are"},
    {"ChunkBeyond", sql("UPDATE field_chunks SET idx = 2 WHERE idx = 1"), "the field ends before it"},
    {"ChunkSize", sql("UPDATE field_chunks SET data = zeroblob(20)"),
     "has 20 bytes, not those of its points"},
    {"ChunkMissing", sql("DELETE FROM field_chunks WHERE idx = 0"), "only 1 of 2 chunks of its field"},
    {"PointNotDone", record("done", kInfinity, 0, wire::kNoDirection), "1 points without a value"},
    {"PointDirection", record("eroding", 0.5, 1, kDirections), "1 points without a value"},
    {"PointErosion", record("eroding", std::nan(""), 1, 0), "1 points without a value"},
    {"PointArea", record("eroding", 0.5, -1, 0), "1 points without a value"},
    {"PointHalfEmpty", record("eroding", 0.5, 0, wire::kNoDirection), "1 points without a value"},
    {"LoggedPoint", logged({0.5, 1, 0, kPoints}), "1 records that no report"},
    {"LoggedDirection", logged({0.5, 1, kDirections, 0}), "1 records that no report"},
    {"LoggedErosion", logged({-0.5, 1, 0, 0}), "1 records that no report"},
    {"FlippedBit", flipped("field_chunks", 81000), "field chunk 0: does not match its checksum"},
    {"FlippedLogBit", flipped("field_log", 3), "logged report 1: does not match its checksum"},
    {"ChunkLost", sql("DELETE FROM field_chunks WHERE erosion_id = EROSION(eroding)"), "chunk 0: is missing"},
    {"QueuePlace", sql("UPDATE tasks SET seq = 99 WHERE job_id = JOB(queued)"), "its place in the queue"},
    {"QueueParked", sql("UPDATE tasks SET parked = 1 WHERE job_id = JOB(queued)"), "its place in the queue"},
    {"ErosionBytes", sql("UPDATE erosions SET bytes = bytes + 1 WHERE id = EROSION(done)"), "bytes, it has "},
    {"OwnerUse", sql("UPDATE owner_use SET stored_bytes = stored_bytes - 1"), "is counted as "},
    {"OwnerQueued", sql("UPDATE owner_use SET queued_jobs = 0"), "is counted as 0 jobs"},
    {"QueueOwner", sql("UPDATE tasks SET owner = 'eve' WHERE job_id = JOB(queued)"),
     "its place in the queue"},
    {"QueueMissing", sql("DELETE FROM queues"), "counts 0 ready tasks of priority 5, there are "},
    {"QueueLeftOver", sql("INSERT INTO queues VALUES ('ada', 0, 'c', 0, 7, 0, 2, 5)"),
     "counts 2 ready tasks of priority 7, there are none"},
    {"QueueTurn", sql("UPDATE queues SET turn = turn + 1"), "does not have its owner's turn"},
    {"ErosionParams", sql("UPDATE erosions SET params = x'ff'"), ", parameters: a stored message"},
    {"SkeletonParams", sql("UPDATE jobs SET skeleton = x'ff'"), ", skeleton parameters: a stored message"},
    {"JobQuality", sql("UPDATE jobs SET quality = x'ff'"), ", quality: a stored message"},
    {"ArtefactQuality", sql("UPDATE artifacts SET quality = x'ff'"), ", quality: a stored message"},
    {"TaskParams", sql("UPDATE tasks SET params = x'ff' WHERE kind = 'skeleton'"),
     ", parameters: a stored message"},
    {"SurfaceParams", sql("UPDATE tasks SET params = x'ff', kind = 'surface' WHERE kind = 'skeleton'"),
     ", parameters: a stored message"},
    {"ErodedParams", sql("UPDATE tasks SET params = x'ff', kind = 'eroded-points' WHERE kind = 'skeleton'"),
     ", parameters: a stored message"},
    {"Summary", sql("UPDATE erosions SET prepared = x'ff' WHERE prepared IS NOT NULL"), "summary: a stored"},
    {"Points", sql("UPDATE erosions SET points = 5001 WHERE points IS NOT NULL"),
     "its summary says 5000 and"},
    {"Directions", sql("UPDATE erosions SET directions = 101 WHERE id = EROSION(eroding)"),
     "its summary says"},
    {"Stride", sql("UPDATE erosions SET stride = 10 WHERE directions = 100"), "has a divisor in common"},
};

class PlantedFaultTest : public CheckDatabaseTest, public testing::WithParamInterface<Planted> {};

TEST_P(PlantedFaultTest, IsFound) {
  store_.reset();
  {
    Database db(database(), Database::Mode::kReadWrite);
    db.execute(
        "PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON;"
        " DROP TRIGGER meshes_are_immutable; DROP TRIGGER mesh_chunks_are_immutable");
    GetParam().plant(db);
  }
  const std::string text = text_of(faults_of(data_dir()));
  EXPECT_NE(text.find(GetParam().found), std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(All, PlantedFaultTest, testing::ValuesIn(kPlanted),
                         [](const auto& planted) { return std::string(planted.param.name); });

}  // namespace
}  // namespace affskel::server
