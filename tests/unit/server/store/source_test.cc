// Jobs whose mesh was repaired before it was submitted: the mesh before is kept with them.

#include "check/check_database.h"
#include "database/sqlite.h"
#include "expect_store_error.h"
#include "store/quota.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

const std::string kMesh = "OFF repaired", kSource = "OFF as it came";

v1::SubmitJobHeader repaired_header(const std::string& mesh = kMesh, const std::string& source = kSource,
                                    const std::string& name = "body") {
  v1::SubmitJobHeader header = submit_header(mesh, name);
  const v1::SubmitJobHeader before = submit_header(source);
  header.mutable_repair()->set_source_sha256(before.mesh_sha256());
  header.mutable_repair()->set_source_bytes(before.mesh_bytes());
  v1::RepairStep& step = *header.mutable_repair()->add_steps();
  step.set_code("filled-holes");
  step.set_count(2);
  step.set_message("2 holes filled");
  step.set_severity("warning");
  return header;
}

class SourceTest : public StoreTest {
 protected:
  v1::Job submit_repaired(const std::string& name = "body") {
    return store_->submit(repaired_header(kMesh, kSource, name), kMesh + kSource).job;
  }

  std::string fetched(const std::string& job, v1::ArtifactKind kind) {
    return read_all(*store_->open_artifact(artifact_request(job, kind)).reader);
  }

  Use use() {
    Database db(database(), Database::Mode::kReadOnly);
    return use_of(db, "ada");
  }

  std::int64_t meshes() {
    Database db(database(), Database::Mode::kReadOnly);
    return db.integer("SELECT count(*) FROM meshes").value();
  }

  void remove(const v1::Job& job) {
    store_->cancel(job.id());
    store_->remove(job.id());
    while (store_->tidy()) {
    }
  }

  void expect_sound() {
    check_database(directory_.path(),
                   [](const Fault& fault) { ADD_FAILURE() << fault.where << ": " << fault.what; });
  }
};

TEST_F(SourceTest, TheMeshBeforeItsRepairIsKeptWithTheReport) {
  const v1::Job job = submit_repaired();
  open();
  EXPECT_EQ(fetched(job.id(), v1::ARTIFACT_KIND_MESH), kMesh);
  EXPECT_EQ(fetched(job.id(), v1::ARTIFACT_KIND_SOURCE), kSource);
  const v1::MeshRepair repair = store_->job(job.id()).repair();
  EXPECT_EQ(repair.SerializeAsString(), repaired_header().repair().SerializeAsString());
  EXPECT_FALSE(store_->list({}).jobs.at(0).has_repair()) << "a list of a thousand would be too long";
  expect_sound();
}

TEST_F(SourceTest, AMeshThatWasNotRepairedHasNone) {
  const v1::Job job = submit(kMesh);
  EXPECT_FALSE(job.has_repair());
  EXPECT_STORE_ERROR(store_->open_artifact(artifact_request(job.id(), v1::ARTIFACT_KIND_SOURCE)), kNotFound);
}

TEST_F(SourceTest, TheSourceIsContent) {
  const v1::Job plain = submit(kMesh);
  const v1::Job repaired = submit_repaired();
  EXPECT_NE(plain.id(), repaired.id());
  EXPECT_EQ(submit_repaired().id(), repaired.id());
  v1::SubmitJobHeader header = repaired_header();
  header.set_request_id("key");
  EXPECT_EQ(store_->submit(header, kMesh + kSource).job.id(), repaired.id());
  const std::string other = "OFF otherwise";
  v1::SubmitJobHeader changed = repaired_header(kMesh, other);
  changed.set_request_id("key");
  EXPECT_STORE_ERROR(store_->submit(changed, kMesh + other), kExists);
}

TEST_F(SourceTest, ASourceGoesWithItsLastJob) {
  const v1::Job first = submit_repaired("first");
  const v1::Job second = submit_repaired("second");
  EXPECT_EQ(meshes(), 2);
  remove(first);
  EXPECT_EQ(fetched(second.id(), v1::ARTIFACT_KIND_SOURCE), kSource);
  expect_sound();
  remove(second);
  EXPECT_EQ(meshes(), 0);
  expect_sound();
}

TEST_F(SourceTest, ASourceThatIsAJobsMeshStaysWithEither) {
  const v1::Job repaired = submit_repaired();
  const v1::Job computed = submit(kSource, "as it came");
  remove(computed);
  EXPECT_EQ(fetched(repaired.id(), v1::ARTIFACT_KIND_SOURCE), kSource);
  expect_sound();
  const v1::Job again = submit(kSource, "as it came");
  remove(repaired);
  EXPECT_EQ(fetched(again.id(), v1::ARTIFACT_KIND_MESH), kSource);
  expect_sound();
}

TEST_F(SourceTest, CountsToWhatItsOwnerHas) {
  const auto both = static_cast<std::int64_t>(kMesh.size() + kSource.size());
  const v1::Job job = submit_repaired();
  submit_repaired("the same again");
  EXPECT_EQ(use().mesh_bytes, both);
  EXPECT_EQ(use().stored_bytes, both);
  remove(job);
  EXPECT_EQ(use().mesh_bytes, both) << "the second job still has them";
}

TEST_F(SourceTest, IsRefusedBeyondTheQuota) {
  options_.policy.everyone.quota.mesh_bytes = static_cast<std::int64_t>(kMesh.size() + kSource.size()) - 1;
  open();
  EXPECT_STORE_ERROR(submit_repaired(), kLimit);
  EXPECT_STORE_ERROR(store_->check(repaired_header()), kLimit);
  submit(kMesh);
}

TEST_F(SourceTest, RefusesWrongReports) {
  const auto refused = [&](auto change, const std::string& why) {
    v1::SubmitJobHeader header = repaired_header();
    change(*header.mutable_repair());
    const std::string said = error_of([&] { store_->submit(header, kMesh + kSource); });
    EXPECT_NE(said.find(why), std::string::npos) << said;
  };
  refused([](auto& r) { r.clear_source_sha256(); }, "source_sha256 is not set");
  refused([](auto& r) { r.set_source_sha256(std::string(64, '0')); }, "not the announced source_sha256");
  refused([](auto& r) { r.clear_source_bytes(); }, "source_bytes is 0");
  refused([](auto& r) { r.set_source_bytes(3); }, "mesh_bytes and source_bytes announced 15 bytes, but 26");
  refused([](auto& r) { r.clear_steps(); }, "at least one step");
  refused([](auto& r) { r.mutable_steps(0)->clear_code(); }, "no code");
  refused([](auto& r) { r.mutable_steps(0)->set_message(std::string(1001, 'm')); }, "1001 bytes");
  refused([](auto& r) { r.mutable_steps(0)->set_severity("error"); }, "\"warning\", not 'error'");
  refused(
      [](auto& r) {
        while (r.steps_size() < 31) *r.add_steps() = r.steps(0);
      },
      "31 steps");
  refused([](auto& r) { r.set_source_bytes(std::uint64_t{1} << 60); }, "takes at most");
  EXPECT_EQ(store_->counts().total, 0);
}

TEST_F(SourceTest, WorkersAreGivenTheRepairedMeshAlone) {
  submit_repaired();
  const v1::Lease prepare = lease();
  EXPECT_EQ(read_all(*store_->open_input(prepare.token(), v1::ARTIFACT_KIND_MESH)), kMesh);
  EXPECT_STORE_ERROR(store_->open_input(prepare.token(), v1::ARTIFACT_KIND_SOURCE), kInvalid);
}

}  // namespace
}  // namespace affskel::server
