#include <set>
#include <string>

#include "expect_store_error.h"
#include "store_fixture.h"
#include "wire/sha256.h"

namespace affskel::server {
namespace {

class ArtifactTest : public StoreTest {
 protected:
  std::string refusal(const v1::FetchArtifactRequest& wanted) {
    return error_of([&] { store_->open_artifact(wanted); });
  }
};

TEST_F(ArtifactTest, LatticeAndDirectionsAreThereAfterPreparing) {
  const v1::Job job = submit();
  EXPECT_STORE_ERROR(store_->open_artifact(artifact_request(job.id(), v1::ARTIFACT_KIND_LATTICE)),
                     kPrecondition);
  prepare(10, 20);
  v1::Lattice lattice;
  ASSERT_TRUE(lattice.ParseFromString(
      read_all(*store_->open_artifact(artifact_request(job.id(), v1::ARTIFACT_KIND_LATTICE)).reader)));
  EXPECT_EQ(lattice.run_length(0), 10U);
  v1::Directions directions;
  ASSERT_TRUE(directions.ParseFromString(
      read_all(*store_->open_artifact(artifact_request(job.id(), v1::ARTIFACT_KIND_DIRECTIONS)).reader)));
  EXPECT_EQ(directions.xyz_size(), 60);
}

TEST_F(ArtifactTest, FieldOnlyWhenComplete) {
  const v1::Job job = submit();
  EXPECT_STORE_ERROR(field(job.id()), kPrecondition);
  prepare(10, 20);
  finish_block(lease());
  EXPECT_STORE_ERROR(field(job.id()), kPrecondition);
  EXPECT_STORE_ERROR(store_->open_artifact(skeleton_request(job.id(), 3)), kPrecondition);
  finish_block(lease());
  EXPECT_EQ(field(job.id()).size(), 200U);
}

TEST_F(ArtifactTest, DefaultSkeletonIsStored) {
  const v1::Job job = complete_job(10, 20);
  EXPECT_EQ(read_all(*store_->open_artifact(artifact_request(job.id(), v1::ARTIFACT_KIND_SKELETON)).reader),
            "skeleton");
  EXPECT_EQ(read_all(*store_->open_artifact(skeleton_request(job.id(), 7)).reader), "skeleton");
}

// Its sheet, with which every face shows it; its vertices as points are made on request.
TEST_F(ArtifactTest, AJobWithASheetIsDoneWithItsSurface) {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  const std::string id = store_->submit(header, "OFF 1").job.id();
  erode(10, 20);
  const v1::Lease task = lease();
  EXPECT_EQ(task.kind(), v1::TASK_KIND_SURFACE);
  EXPECT_EQ(task.surface().skeleton().operator_(), v1::OPERATOR_RIDGE);
  v1::CompleteTaskHeader done = derive_header(task.token(), "sheet", 3);
  done.mutable_quality()->set_components(1);
  store_->complete(done, "sheet");
  const v1::Job job = store_->job(id);
  EXPECT_EQ(job.state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(job.skeleton_points(), 3U);
  EXPECT_EQ(job.quality().components(), 1U);
  EXPECT_EQ(read_all(*store_->open_artifact(artifact_request(id, v1::ARTIFACT_KIND_SURFACE)).reader),
            "sheet");
  EXPECT_EQ(store_->open_artifact(artifact_request(id, v1::ARTIFACT_KIND_SKELETON)).reader, nullptr);
  EXPECT_EQ(lease().kind(), v1::TASK_KIND_SKELETON);
}

TEST_F(ArtifactTest, JobsOfWhichMuchIsRequestedHideNoOthers) {
  const std::string first = complete_job(10, 20).id(), second = submit("OFF 2", "other").id();
  erode(10, 20);
  derive();
  for (int threshold = 1; threshold <= 20; ++threshold)
    store_->open_artifact(skeleton_request(first, threshold));
  store_->open_artifact(skeleton_request(second, 3));
  EXPECT_EQ(store_->requested_jobs(), (std::set<std::string>{first, second}));
}

TEST_F(ArtifactTest, OtherSkeletonIsMadeOnceAndKept) {
  const v1::Job job = complete_job(10, 20);
  const Store::ArtifactState first = store_->open_artifact(skeleton_request(job.id(), 3));
  ASSERT_EQ(first.reader, nullptr);
  EXPECT_EQ(store_->open_artifact(skeleton_request(job.id(), 3)).task, first.task)
      << "one task for all who ask";
  EXPECT_EQ(store_->counts().requests, 1);
  const v1::Lease task = lease();
  EXPECT_EQ(task.kind(), v1::TASK_KIND_SKELETON);
  EXPECT_EQ(task.skeleton().threshold(), 3);
  store_->complete(derive_header(task.token(), "finer", 9), "finer");
  EXPECT_EQ(read_all(*store_->open_artifact(skeleton_request(job.id(), 3)).reader), "finer");
  EXPECT_EQ(store_->counts().requests, 0);
  EXPECT_EQ(store_->job(job.id()).skeleton_points(), 3U) << "of the default skeleton";
  open();
  EXPECT_EQ(read_all(*store_->open_artifact(skeleton_request(job.id(), 3)).reader), "finer");
}

TEST_F(ArtifactTest, SurfaceTakesTheJobsSkeletonByDefault) {
  const v1::Job job = complete_job(10, 20);
  ASSERT_EQ(store_->open_artifact(artifact_request(job.id(), v1::ARTIFACT_KIND_SURFACE)).reader, nullptr);
  const v1::Lease task = lease();
  EXPECT_EQ(task.kind(), v1::TASK_KIND_SURFACE);
  EXPECT_EQ(task.surface().skeleton().threshold(), job.skeleton().threshold());
  EXPECT_EQ(task.surface().alpha(), 0);
  store_->complete(derive_header(task.token(), "surface", 2), "surface");
  EXPECT_EQ(read_all(*store_->open_artifact(artifact_request(job.id(), v1::ARTIFACT_KIND_SURFACE)).reader),
            "surface");
}

TEST_F(ArtifactTest, DivergenceAndErodedSolidsAreMadeOnRequest) {
  const v1::Job job = complete_job(10, 20);
  v1::FetchArtifactRequest divergence = skeleton_request(job.id(), 3);
  divergence.set_kind(v1::ARTIFACT_KIND_DIVERGENCE);
  ASSERT_EQ(store_->open_artifact(divergence).reader, nullptr);
  v1::Lease task = lease();
  EXPECT_EQ(task.kind(), v1::TASK_KIND_DIVERGENCE);
  EXPECT_EQ(task.skeleton().operator_(), v1::OPERATOR_ZUCKER_HUMMEL);
  store_->complete(derive_header(task.token(), "H", 10), "H");
  divergence.mutable_skeleton()->set_threshold(4);
  EXPECT_EQ(read_all(*store_->open_artifact(divergence).reader), "H") << "the same for every threshold";

  v1::FetchArtifactRequest eroded = artifact_request(job.id(), v1::ARTIFACT_KIND_ERODED_SURFACE);
  ASSERT_EQ(store_->open_artifact(eroded).reader, nullptr);
  task = lease();
  EXPECT_EQ(task.kind(), v1::TASK_KIND_ERODED_SURFACE);
  EXPECT_EQ(task.eroded().fraction(), 0.1);
  store_->complete(derive_header(task.token(), "mesh", 2), "mesh");
  EXPECT_EQ(read_all(*store_->open_artifact(eroded).reader), "mesh");
  eroded.set_kind(v1::ARTIFACT_KIND_ERODED_POINTS);
  eroded.mutable_eroded()->set_volume(5);
  ASSERT_EQ(store_->open_artifact(eroded).reader, nullptr);
  EXPECT_EQ(lease().eroded().volume(), 5);
}

TEST_F(ArtifactTest, QualityOfTheDefaultSkeletonBelongsToTheJob) {
  const v1::Job job = submit();
  prepare(10, 16);
  finish_block(lease());
  const v1::Lease task = lease();
  ASSERT_EQ(task.kind(), v1::TASK_KIND_SKELETON);
  v1::CompleteTaskHeader header = derive_header(task.token(), "skeleton", 3);
  header.mutable_quality()->set_components(2);
  store_->complete(header, "skeleton");
  EXPECT_EQ(store_->job(job.id()).quality().components(), 2U);
  open();
  EXPECT_EQ(store_->job(job.id()).quality().components(), 2U);
}

TEST_F(ArtifactTest, RequestsComeBeforeJobs) {
  const v1::Job job = complete_job(10, 20);
  v1::SubmitJobHeader urgent = submit_header("OFF 2");
  urgent.set_priority(9);
  store_->submit(urgent, "OFF 2");
  store_->open_artifact(skeleton_request(job.id(), 3));
  EXPECT_EQ(lease().kind(), v1::TASK_KIND_SKELETON);
}

TEST_F(ArtifactTest, FailedRequestLeavesTheJobAlone) {
  const v1::Job job = complete_job(10, 20);
  const std::int64_t task = store_->open_artifact(skeleton_request(job.id(), 3)).task;
  EXPECT_FALSE(store_->open_artifact(skeleton_request(job.id(), 3), task).error);
  v1::JobError error;
  error.set_code("LIMIT");
  error.set_message("too many points");
  store_->fail(lease().token(), error, false);
  const Store::ArtifactState failed = store_->open_artifact(skeleton_request(job.id(), 3), task);
  ASSERT_TRUE(failed.error);
  EXPECT_EQ(failed.error->message(), "too many points");
  EXPECT_EQ(failed.task, task);
  EXPECT_FALSE(has_work()) << "whoever waits for it does not start it anew";
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_NE(store_->open_artifact(skeleton_request(job.id(), 3)).task, task) << "asking again tries again";
}

TEST_F(ArtifactTest, RequestIsGivenUpAfterTooManyLosses) {
  const v1::Job job = complete_job(10, 20);
  const std::int64_t task = store_->open_artifact(skeleton_request(job.id(), 3)).task;
  for (std::int64_t i = 0; i < options_.max_losses; ++i) {
    lease();
    clock_.advance(options_.lease_ms + 1);
    store_->expire_leases();
  }
  const Store::ArtifactState lost = store_->open_artifact(skeleton_request(job.id(), 3), task);
  ASSERT_TRUE(lost.error);
  EXPECT_EQ(lost.error->code(), "WORKER_LOST");
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_FALSE(has_work());
}

TEST_F(ArtifactTest, RefusesWrongRequests) {
  const v1::Job job = complete_job(10, 20);
  EXPECT_STORE_ERROR(store_->open_artifact(skeleton_request(job.id(), -1)), kInvalid);
  EXPECT_STORE_ERROR(store_->open_artifact(artifact_request(job.id(), v1::ARTIFACT_KIND_UNSPECIFIED)),
                     kInvalid);
  v1::FetchArtifactRequest surface = artifact_request(job.id(), v1::ARTIFACT_KIND_SURFACE);
  surface.mutable_surface()->set_alpha(-1);
  EXPECT_STORE_ERROR(store_->open_artifact(surface), kInvalid);
  surface.mutable_surface()->set_alpha(0);
  surface.mutable_surface()->set_barrier(true);
  EXPECT_NE(refusal(surface).find("zucker-hummel gives points"), std::string::npos) << "the job's operator";
  v1::FetchArtifactRequest eroded = artifact_request(job.id(), v1::ARTIFACT_KIND_ERODED_POINTS);
  eroded.mutable_eroded()->set_fraction(2);
  EXPECT_STORE_ERROR(store_->open_artifact(eroded), kInvalid);
  v1::FetchArtifactRequest divergence = artifact_request(job.id(), v1::ARTIFACT_KIND_DIVERGENCE);
  divergence.mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  EXPECT_STORE_ERROR(store_->open_artifact(divergence), kInvalid);
}

TEST_F(ArtifactTest, RefusesParametersThatItWouldIgnore) {
  const v1::Job job = complete_job(10, 20);
  for (int kind = 1; kind < v1::ArtifactKind_ARRAYSIZE; ++kind) {
    for (const std::string word : {"skeleton", "surface", "eroded"}) {
      v1::FetchArtifactRequest wrong = artifact_request(job.id(), static_cast<v1::ArtifactKind>(kind));
      const std::string name = v1::ArtifactKind_Name(wrong.kind());
      bool right = false;
      if (word == "skeleton") {
        wrong.mutable_skeleton()->set_threshold(3);
        right = name.ends_with("SKELETON") || name.ends_with("DIVERGENCE") || name.ends_with("PARTS");
      } else if (word == "surface") {
        wrong.mutable_surface()->set_alpha(3);
        right = name == "ARTIFACT_KIND_SURFACE";
      } else {
        wrong.mutable_eroded()->set_fraction(0.5);
        right = name.find("ERODED") != std::string::npos;
      }
      if (right) {
        EXPECT_NO_THROW(store_->open_artifact(wrong)) << name << " " << word;
      } else {
        EXPECT_NE(refusal(wrong).find("'" + word + "'"), std::string::npos) << name << " " << word;
      }
    }
  }
  EXPECT_NE(refusal(artifact_request(job.id(), static_cast<v1::ArtifactKind>(99))).find("99"),
            std::string::npos);
}

TEST_F(ArtifactTest, TellsWhyAJobThatHasEndedHasNoField) {
  const v1::Job job = submit();
  const v1::FetchArtifactRequest field = artifact_request(job.id(), v1::ARTIFACT_KIND_FIELD);
  EXPECT_NE(refusal(field).find(" yet (queued, stage prepare)"), std::string::npos) << refusal(field);
  store_->cancel(job.id());
  EXPECT_NE(refusal(field).find("cancelled"), std::string::npos) << refusal(field);
  EXPECT_EQ(refusal(field).find("yet"), std::string::npos) << refusal(field);
  store_->resume(job.id());
  v1::JobError error;
  error.set_code("BAD_INPUT");
  error.set_message("edge 3 is open");
  store_->fail(lease().token(), error, false);
  EXPECT_NE(refusal(field).find("BAD_INPUT: edge 3 is open"), std::string::npos) << refusal(field);
  EXPECT_EQ(refusal(field).find("yet"), std::string::npos) << refusal(field);
}

TEST_F(ArtifactTest, ReaderSeesOneStateWhileReportsGoOn) {
  submit();
  prepare(100000, 16);  // several messages long
  const v1::Lease block = lease();
  report(block, 0, 1);
  const std::unique_ptr<BlobReader> reader = store_->open_input(block.token(), v1::ARTIFACT_KIND_FIELD);
  std::string bytes = reader->next();
  ASSERT_LT(bytes.size(), reader->bytes());
  report(block, 1, 2);
  for (std::string piece = reader->next(); !piece.empty(); piece = reader->next()) bytes += piece;
  EXPECT_EQ(wire::sha256_hex(bytes), reader->sha256());
}

}  // namespace
}  // namespace affskel::server
