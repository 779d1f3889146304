#include <cctype>

#include "expect_store_error.h"
#include "store_fixture.h"

namespace affskel::server {
namespace {

using SubmitTest = StoreTest;

std::string in_capitals(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

TEST_F(SubmitTest, StoresMeshAndJob) {
  const std::string mesh = std::string("OFF\n\0binary is kept", 19) + std::string(3 << 20, 'x');
  const v1::Job job = submit(mesh);
  EXPECT_EQ(job.id().size(), 32U);
  EXPECT_EQ(job.state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(job.stage(), v1::JOB_STAGE_PREPARE);
  EXPECT_EQ(job.mesh_bytes(), mesh.size());
  EXPECT_EQ(job.params().directions(), "triangles");
  EXPECT_EQ(job.skeleton().operator_(), v1::OPERATOR_ZUCKER_HUMMEL);
  v1::FetchArtifactRequest request = artifact_request(job.id(), v1::ARTIFACT_KIND_MESH);
  EXPECT_EQ(read_all(*store_->open_artifact(request).reader), mesh);
}

TEST_F(SubmitTest, AJobWithoutAnOperatorHasTheRidges) {
  const std::string mesh = "OFF 1";
  v1::SubmitJobHeader header = submit_header(mesh);
  header.clear_skeleton();
  const v1::Job job = store_->submit(header, mesh).job;
  EXPECT_EQ(job.skeleton().operator_(), v1::OPERATOR_RIDGE);
  header.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  EXPECT_EQ(store_->submit(header, mesh).job.id(), job.id());
}

TEST_F(SubmitTest, RefusesWrongHeaders) {
  const std::string mesh = "OFF 1";
  const auto refused = [&](auto change) {
    v1::SubmitJobHeader header = submit_header(mesh);
    change(header);
    EXPECT_STORE_ERROR(store_->submit(header, mesh), kInvalid);
  };
  refused([](auto& h) { h.set_mesh_bytes(4); });
  refused([](auto& h) { h.set_mesh_sha256(std::string(64, '0')); });
  refused([](auto& h) { h.set_priority(10); });
  refused([](auto& h) { h.set_name(std::string(201, 'n')); });
  for (const char control : {'\0', '\n', '\x1b', '\x7f'})
    refused([&](auto& h) { h.set_name(std::string("a") + control + "b"); });
  for (const char* control : {"\u0080", "\u0085", "\u009f"})
    refused([&](auto& h) { h.set_name(std::string("a") + control + "b"); });
  refused([](auto& h) { h.set_owner(std::string(101, 'n')); });
  refused([](auto& h) { h.mutable_params()->clear_sampling(); });
  refused([](auto& h) { h.mutable_params()->mutable_sampling()->set_spacing(-1); });
  refused([](auto& h) { h.mutable_params()->set_directions("circle:5"); });
  refused([](auto& h) {
    std::string many = "triangles";
    for (int i = 0; i < 100; ++i) many += "+triangles";
    h.mutable_params()->set_directions(many);
  });
  refused([](auto& h) { h.mutable_skeleton()->set_threshold(-1); });
  EXPECT_EQ(store_->counts().total, 0);
}

TEST_F(SubmitTest, HeadersAreCheckedWithoutTheirMesh) {
  const v1::SubmitJobHeader good = submit_header("OFF 1");
  const auto refusal = [&](auto change) {
    v1::SubmitJobHeader header = good;
    change(header);
    return error_of([&] { store_->check(header); });
  };
  EXPECT_EQ(refusal([](auto&) {}), "");
  const auto expect = [](const std::string& message, const std::string& value, const std::string& allowed) {
    EXPECT_NE(message.find(value), std::string::npos) << message;
    EXPECT_NE(message.find(allowed), std::string::npos) << message;
  };
  expect(refusal([](auto& h) { h.set_priority(12); }), "12", "0 .. 9");
  expect(refusal([](auto& h) { h.set_name(std::string(201, 'n')); }), "name has 201", "200");
  expect(refusal([](auto& h) { h.clear_mesh_sha256(); }), "mesh_sha256", "not set");
  expect(refusal([](auto& h) { h.set_mesh_sha256("xyz"); }), "'xyz'", "64 hexadecimal digits");
  expect(refusal([](auto& h) { h.clear_mesh_bytes(); }), "mesh_bytes", "not set");
  expect(refusal([](auto& h) { h.mutable_params()->mutable_sampling()->set_spacing(-2); }), "-2", "> 0");
  expect(refusal([](auto& h) { h.mutable_params()->set_frame(static_cast<v1::Frame>(77)); }), "77", "frame");
  expect(refusal([](auto& h) { h.mutable_skeleton()->set_operator_(static_cast<v1::Operator>(78)); }), "78",
         "operator");
  expect(refusal([](auto& h) { h.mutable_params()->set_directions(std::string("a\0\n", 3)); }),
         "'a\\x00\\x0a'", "sphere:N");

  v1::SubmitJobHeader used = good;
  used.set_request_id("key\n");
  store_->submit(used, "OFF 1");
  EXPECT_EQ(error_of([&] { store_->check(used); }), "");
  used.set_mesh_sha256(std::string(64, '0'));
  expect(error_of([&] { store_->check(used); }), "'key\\x0a'", "another submission");
}

TEST_F(SubmitTest, TellsWhatArrivedInsteadOfWhatWasAnnounced) {
  const v1::SubmitJobHeader header = submit_header("OFF 1");
  const std::string nothing = error_of([&] { store_->submit(header, ""); });
  EXPECT_NE(nothing.find("announced 5 bytes, but 0 arrived"), std::string::npos) << nothing;
  const std::string other = error_of([&] { store_->submit(header, "OFF 2"); });
  EXPECT_NE(other.find(submit_header("OFF 2").mesh_sha256()), std::string::npos) << other;
}

TEST_F(SubmitTest, HexadecimalDigitsHaveNoCase) {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.set_mesh_sha256(in_capitals(header.mesh_sha256()));
  const v1::Job job = store_->submit(header, "OFF 1").job;
  EXPECT_EQ(job.mesh_sha256(), submit_header("OFF 1").mesh_sha256());
  EXPECT_TRUE(store_->submit(submit_header("OFF 1"), "OFF 1").existed);
  EXPECT_EQ(store_->resolve(in_capitals(job.id())), job.id());
  EXPECT_EQ(store_->resolve(in_capitals(job.id().substr(0, 10))), job.id());
}

TEST_F(SubmitTest, JobReferencesAreQuotedSafely) {
  const std::string nul = error_of([&] { store_->resolve(std::string("x\0y", 3)); });
  EXPECT_NE(nul.find("'x\\x00y': expected an id"), std::string::npos) << nul;
  EXPECT_LT(error_of([&] { store_->resolve(std::string(5000, 'x')); }).size(), 300U);
}

TEST_F(SubmitTest, RefusesEmptyAndTooLargeMeshes) {
  EXPECT_STORE_ERROR(store_->submit(submit_header(""), ""), kInvalid);
  options_.max_mesh_bytes = 10;
  open();
  const std::string mesh(11, 'm');
  EXPECT_STORE_ERROR(store_->submit(submit_header(mesh), mesh), kLimit);
}

TEST_F(SubmitTest, SameSubmissionIsTheSameJob) {
  const std::string mesh = "OFF 1";
  const Store::Submitted first = store_->submit(submit_header(mesh), mesh);
  EXPECT_FALSE(first.existed);
  v1::SubmitJobHeader spelled_otherwise = submit_header(mesh);
  spelled_otherwise.mutable_params()->set_directions("triangles");
  spelled_otherwise.mutable_skeleton()->set_threshold(7);
  spelled_otherwise.set_priority(8);
  const Store::Submitted second = store_->submit(spelled_otherwise, mesh);
  EXPECT_TRUE(second.existed);
  EXPECT_EQ(second.job.id(), first.job.id());
  EXPECT_EQ(second.job.priority(), 8U) << "as urgent as the more urgent of the two";
}

TEST_F(SubmitTest, OtherContentIsAnotherJob) {
  const std::string id = submit("OFF 1").id();
  EXPECT_NE(submit("OFF 2").id(), id);
  EXPECT_NE(submit("OFF 1", "another name").id(), id);
  v1::SubmitJobHeader finer = submit_header("OFF 1");
  finer.mutable_params()->mutable_sampling()->set_spacing(0.25 + 1e-16);
  EXPECT_NE(store_->submit(finer, "OFF 1").job.id(), id);
}

TEST_F(SubmitTest, RequestIdsNameOneSubmission) {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.set_request_id("key");
  const std::string id = store_->submit(header, "OFF 1").job.id();
  EXPECT_TRUE(store_->submit(header, "OFF 1").existed);
  open();
  EXPECT_EQ(store_->submit(header, "OFF 1").job.id(), id);
  v1::SubmitJobHeader other = submit_header("OFF 2");
  other.set_request_id("key");
  EXPECT_STORE_ERROR(store_->submit(other, "OFF 2"), kExists);
  header.set_name("renamed");
  EXPECT_STORE_ERROR(store_->submit(header, "OFF 1"), kExists);
  EXPECT_EQ(store_->counts().total, 1);
}

TEST_F(SubmitTest, ThePriorityIsNoContent) {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.set_request_id("key");
  header.set_priority(3);
  const std::string id = store_->submit(header, "OFF 1").job.id();
  for (const auto& [asked, got] : {std::pair{7U, 7U}, std::pair{2U, 7U}}) {
    header.set_priority(asked);
    const Store::Submitted again = store_->submit(header, "OFF 1");
    EXPECT_TRUE(again.existed);
    EXPECT_EQ(again.job.id(), id);
    EXPECT_EQ(again.job.priority(), got);
  }
  header.mutable_skeleton()->set_threshold(3);
  EXPECT_STORE_ERROR(store_->submit(header, "OFF 1"), kExists);
}

TEST_F(SubmitTest, RequestIdFindsItsJobEvenWhenItFailed) {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.set_request_id("key");
  const std::string id = store_->submit(header, "OFF 1").job.id();
  store_->cancel(id);
  EXPECT_EQ(store_->submit(header, "OFF 1").job.id(), id);
  header.clear_request_id();
  EXPECT_NE(store_->submit(header, "OFF 1").job.id(), id) << "a cancelled job answers no new submission";
}

TEST_F(SubmitTest, FinishedJobAnswersAtOnce) {
  const v1::Job done = complete_job(10, 20);
  ASSERT_EQ(done.state(), v1::JOB_STATE_DONE);
  const Store::Submitted again = store_->submit(submit_header("OFF 1"), "OFF 1");
  EXPECT_TRUE(again.existed);
  EXPECT_EQ(again.job.id(), done.id());
}

TEST_F(SubmitTest, FinishedFieldIsSharedWithOtherNames) {
  const v1::Job done = complete_job(10, 20);
  const v1::Job shared = submit("OFF 1", "another name");
  EXPECT_NE(shared.id(), done.id());
  EXPECT_EQ(shared.state(), v1::JOB_STATE_DONE) << "field and skeleton are there already";
  EXPECT_EQ(shared.skeleton_points(), done.skeleton_points());
  EXPECT_EQ(shared.counters().directions_reported(), 0U);
  EXPECT_EQ(field(shared.id()), expected_field(10, 20));
}

TEST_F(SubmitTest, OtherSkeletonNeedsOnlyTheSkeleton) {
  complete_job(10, 20);
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.mutable_skeleton()->set_threshold(3);
  const v1::Job job = store_->submit(header, "OFF 1").job;
  EXPECT_EQ(job.stage(), v1::JOB_STAGE_DERIVE);
  const v1::Lease task = lease();
  EXPECT_EQ(task.kind(), v1::TASK_KIND_SKELETON);
  EXPECT_EQ(task.skeleton().threshold(), 3);
  store_->complete(derive_header(task.token(), "s", 1), "s");
  EXPECT_EQ(store_->job(job.id()).state(), v1::JOB_STATE_DONE);
}

TEST_F(SubmitTest, JobSubmittedMeanwhileAdoptsTheFinishedField) {
  const v1::Job first = submit("OFF 1", "first");
  prepare(10, 20);
  const v1::Job second = submit("OFF 1", "second");  // nothing finished to share yet
  EXPECT_EQ(second.stage(), v1::JOB_STAGE_PREPARE);
  finish_block(lease());
  finish_block(lease());
  derive();
  EXPECT_EQ(store_->job(first.id()).state(), v1::JOB_STATE_DONE);
  EXPECT_FALSE(has_work());
  EXPECT_EQ(store_->job(second.id()).state(), v1::JOB_STATE_DONE);
}

TEST_F(SubmitTest, OtherCoreVersionComputesAnew) {
  const v1::Job done = complete_job(10, 20);
  const v1::Job other = submit("OFF 2");
  const std::optional<v1::Lease> newer = store_->lease(worker_identity("worker-b", "2"), "", false);
  ASSERT_TRUE(newer);
  EXPECT_EQ(newer->job().id(), other.id());
  const Store::Submitted again = store_->submit(submit_header("OFF 1"), "OFF 1");
  EXPECT_FALSE(again.existed) << "workers of a newer core are here: the old field does not answer";
  EXPECT_NE(again.job.id(), done.id());
}

TEST_F(SubmitTest, FindsJobsByPrefixAndLast) {
  const std::string first = submit("OFF 1").id();
  const std::string second = submit("OFF 2").id();
  EXPECT_EQ(store_->resolve(first), first);
  EXPECT_EQ(store_->resolve(first.substr(0, 12)), first);
  EXPECT_EQ(store_->resolve("@last"), second);
  EXPECT_STORE_ERROR(store_->resolve(first.substr(0, 5)), kInvalid);
  EXPECT_STORE_ERROR(store_->resolve("no-hex-digits"), kInvalid);
  EXPECT_STORE_ERROR(store_->resolve(std::string(32, first[0] == '0' ? '1' : '0')), kNotFound);
}

TEST_F(SubmitTest, LastIsWhatWasLastToldToASubmitter) {
  const std::string first = submit("OFF 1").id(), second = submit("OFF 2").id();
  EXPECT_EQ(store_->submit(submit_header("OFF 1"), "OFF 1").job.id(), first);
  EXPECT_EQ(store_->resolve("@last"), first);
  EXPECT_EQ(store_->submit(submit_header("OFF 2"), "OFF 2").job.id(), second);
  EXPECT_EQ(store_->resolve("@last"), second);
  EXPECT_EQ(store_->submit(submit_header("OFF 1"), "OFF 1").job.id(), first);
  const std::string third = submit("OFF 3").id();
  EXPECT_EQ(store_->resolve("@last"), third);
  EXPECT_EQ(store_->submit(submit_header("OFF 1"), "OFF 1").job.id(), first);
  store_->cancel(first);
  store_->remove(first);
  EXPECT_EQ(store_->resolve("@last"), third);
}

TEST_F(SubmitTest, PagesStayRightWhileJobsComeAndGo) {
  std::vector<std::string> ids;
  for (int i = 0; i < 7; ++i) ids.push_back(submit("OFF " + std::to_string(i)).id());
  std::vector<std::string> seen;
  const auto page = [&](std::int64_t before) {
    ListFilter filter;
    filter.limit = 2;
    filter.before = before;
    JobPage found = store_->list(filter);
    for (const v1::Job& job : found.jobs) seen.push_back(job.id());
    return found.next;
  };
  std::int64_t next = page(0);
  submit("OFF newer");
  // The last of a page, one of the next, and with it the number that begins the page after.
  for (int gone : {5, 4}) {
    store_->cancel(ids[static_cast<std::size_t>(gone)]);
    store_->remove(ids[static_cast<std::size_t>(gone)]);
  }
  while (next != 0) next = page(next);
  EXPECT_EQ(seen, (std::vector<std::string>{ids[6], ids[5], ids[3], ids[2], ids[1], ids[0]}));
}

TEST_F(SubmitTest, AFullPageOfTheLastJobsIsTheLast) {
  for (int i = 0; i < 4; ++i) submit("OFF " + std::to_string(i));
  ListFilter filter;
  filter.limit = 4;
  EXPECT_EQ(store_->list(filter).next, 0);
  filter.limit = 3;
  EXPECT_NE(store_->list(filter).next, 0);
}

TEST_F(SubmitTest, ListsNewestFirstWithFilters) {
  const std::string first = submit("OFF 1").id();
  const std::string second = submit("OFF 2").id();
  v1::SubmitJobHeader header = submit_header("OFF 3");
  header.set_owner("grace");
  const std::string third = store_->submit(header, "OFF 3").job.id();
  store_->cancel(first);
  const auto ids = [&](const ListFilter& filter) {
    std::vector<std::string> found;
    for (const v1::Job& job : store_->list(filter).jobs) found.push_back(job.id());
    return found;
  };
  EXPECT_EQ(ids({}), (std::vector<std::string>{third, second, first}));
  EXPECT_EQ(ids({{}, "ada", 50}), (std::vector<std::string>{second, first}));
  EXPECT_EQ(ids({{v1::JOB_STATE_CANCELLED}, "", 50}), (std::vector<std::string>{first}));
  EXPECT_EQ(ids({{v1::JOB_STATE_CANCELLED, v1::JOB_STATE_QUEUED}, "", 2}),
            (std::vector<std::string>{third, second}));
}

}  // namespace
}  // namespace affskel::server
