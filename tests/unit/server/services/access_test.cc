#include <unistd.h>

#include <filesystem>

#include "access/gate.h"
#include "access_fixture.h"
#include "every_call.h"

namespace affskel::server {
namespace {

TEST_F(AccessTest, EveryCallIsRefusedWithoutAGoodTokenAndNothingElseIsLearnt) {
  start();
  const std::string job = submit("OFF mine");
  add("ada", v1::ROLE_ADMIN);
  spit("token.unknown", "affskel_nobody\n");
  const std::int64_t revoked = add("revoked", v1::ROLE_ADMIN);
  revoke(revoked);
  add("expired", v1::ROLE_ADMIN, unix_ms() - 1);
  const std::vector<std::pair<std::string, std::string>> refusals = {
      {"", "this server asks for a token (--token-file)"},
      {"unknown", "the token is none of this server's"},
      {"revoked", "the token has been revoked"},
      {"expired", "the token has expired"}};
  for (const auto& [owner, message] : refusals) {
    const auto channel = tcp(owner);
    for (const auto& [name, call] : every_call(job)) {
      const grpc::Status status = call(channel);
      EXPECT_EQ(status.error_code(), grpc::UNAUTHENTICATED) << name << " " << owner;
      EXPECT_EQ(status.error_message(), message) << name;
    }
  }
  EXPECT_EQ(this->job(job).state(), v1::JOB_STATE_QUEUED) << "nothing was done to it";
}

TEST_F(AccessTest, EachRoleCallsItsServiceAlone) {
  start();
  add("user", v1::ROLE_USER);
  add("worker", v1::ROLE_WORKER);
  add("admin", v1::ROLE_ADMIN);
  const std::string job = submit_as("user", "OFF mine");
  for (const auto& [name, call] : every_call(job)) {
    if (name == "DeleteJob") continue;  // the others are about the job
    const bool for_clients =
        v1::SubmitJobRequest::descriptor()->file()->service(0)->FindMethodByName(name) != nullptr;
    const auto is_denied = [&](const std::string& owner) {
      return call(tcp(owner)).error_code() == grpc::PERMISSION_DENIED;
    };
    EXPECT_EQ(is_denied("user"), !for_clients) << name;
    EXPECT_EQ(is_denied("worker"), for_clients) << name;
    EXPECT_FALSE(is_denied("admin")) << name;
  }
}

TEST_F(AccessTest, AnothersJobAndNoJobLookAlike) {
  start();
  add("ada", v1::ROLE_USER);
  add("bob", v1::ROLE_USER);
  const std::string job = submit_as("ada", "OFF ada's");
  const std::string nothing = std::string(job.rbegin(), job.rend());
  const auto channel = tcp("bob");
  const auto others = every_call(job), nobodys = every_call(nothing);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const std::string& name = others[i].first;
    const bool about_a_job = name.ends_with("Job") || name == "FetchArtifact" || name == "ListJobEvents";
    if (!about_a_job || name == "SubmitJob") continue;
    const grpc::Status other = others[i].second(channel), nobody = nobodys[i].second(channel);
    EXPECT_EQ(other.error_code(), grpc::NOT_FOUND) << name;
    EXPECT_EQ(nobody.error_code(), grpc::NOT_FOUND) << name;
    EXPECT_EQ(other.error_message(), "no job " + job) << name;
    EXPECT_EQ(nobody.error_message(), "no job " + nothing) << name;
  }
  const auto bob = client("bob"), ada = client("ada");
  for (const std::string& name : {job.substr(0, 6), std::string("@last")}) {
    EXPECT_EQ(get(*bob, name).error_code(), grpc::NOT_FOUND) << name;
    EXPECT_TRUE(get(*ada, name).ok()) << name;
  }
  for (const std::string& owner : {std::string(), std::string("ada")}) {
    grpc::ClientContext context;
    v1::ListJobsRequest request;
    request.set_owner(owner);
    v1::ListJobsResponse response;
    ASSERT_TRUE(bob->ListJobs(&context, request, &response).ok());
    EXPECT_EQ(response.jobs_size(), 0) << owner;
  }
}

TEST_F(AccessTest, AnOwnerHasHisOwnLastJobRequestIdsAndList) {
  start();
  add("ada", v1::ROLE_USER);
  add("bob", v1::ROLE_USER);
  add("root", v1::ROLE_ADMIN);
  const std::string adas = submit_as("ada", "OFF 1", "key");
  const std::string bobs = submit_as("bob", "OFF 1", "key");
  EXPECT_NE(adas, bobs) << "one mesh, one key, two owners";
  EXPECT_EQ(submit_as("ada", "OFF 1", "key"), adas);
  v1::Job job;
  ASSERT_TRUE(get(*client("ada"), "@last", &job).ok());
  EXPECT_EQ(job.id(), adas);
  ASSERT_TRUE(get(*client("bob"), "@last", &job).ok());
  EXPECT_EQ(job.id(), bobs);
  const auto admin = client("root");
  EXPECT_EQ(get(*admin, "@last").error_code(), grpc::NOT_FOUND) << "he has none";
  EXPECT_TRUE(get(*admin, adas).ok());
  grpc::ClientContext context;
  v1::ListJobsResponse response;
  ASSERT_TRUE(admin->ListJobs(&context, {}, &response).ok());
  EXPECT_EQ(response.jobs_size(), 2);
}

TEST_F(AccessTest, AUserCannotSubmitForAnother) {
  start();
  add("ada", v1::ROLE_USER);
  add("root", v1::ROLE_ADMIN);
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.set_owner("bob");
  v1::SubmitJobResponse response;
  ASSERT_TRUE(submit_mesh(*client("ada"), header, "OFF 1", &response).ok());
  EXPECT_EQ(response.job().owner(), "ada");
  ASSERT_TRUE(submit_mesh(*client("root"), header, "OFF 1", &response).ok());
  EXPECT_EQ(response.job().owner(), "bob");
}

TEST_F(AccessTest, WhoAsksIsToldAndSeesNoMoreThanHisOwn) {
  start();
  add("ada", v1::ROLE_USER);
  add("root", v1::ROLE_ADMIN);
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.set_owner("bob");
  v1::SubmitJobResponse submitted;
  ASSERT_TRUE(submit_mesh(*client("root"), header, "OFF 1", &submitted).ok());
  v1::ServerInfo response;
  ASSERT_TRUE(info(*client("ada"), &response).ok());
  EXPECT_EQ(response.caller().owner(), "ada");
  EXPECT_EQ(response.caller().role(), v1::ROLE_USER);
  EXPECT_EQ(response.data_dir(), "");
  EXPECT_EQ(response.pid(), 0U);
  EXPECT_EQ(response.jobs_total(), 0U) << "bob's is bob's";
  EXPECT_EQ(response.jobs_queued(), 0U);
  EXPECT_EQ(response.database_bytes(), 0U);
  EXPECT_FALSE(response.has_disk_free_bytes());
  ASSERT_TRUE(info(*client("root"), &response).ok());
  EXPECT_EQ(response.data_dir(), options_.data_dir);
  EXPECT_EQ(response.jobs_total(), 1U);
  EXPECT_GE(response.database_bytes(), std::filesystem::file_size(options_.data_dir + "/affskel.db"));
  EXPECT_GT(response.disk_free_bytes(), 0U);
  ASSERT_TRUE(info(*client_, &response).ok()) << "by the Unix socket";
  EXPECT_EQ(response.caller().role(), v1::ROLE_ADMIN);
  EXPECT_EQ(response.caller().owner(), user_name(geteuid()));
}

TEST_F(AccessTest, RevokingEndsCallsInMidStream) {
  start();
  const std::int64_t id = add("ada", v1::ROLE_USER);
  const std::string job = submit_as("ada", "OFF 1");
  const auto ada = client("ada");
  grpc::ClientContext context, waiting_context;
  v1::WatchJobRequest request;
  request.set_job(job);
  const auto reader = ada->WatchJob(&context, request);
  v1::Job seen;
  ASSERT_TRUE(reader->Read(&seen));
  v1::SubmitJobResponse response;
  grpc::ClientContext upload_context;
  const auto writer = ada->SubmitJob(&upload_context, &response);
  v1::SubmitJobRequest header;
  *header.mutable_header() = submit_header("OFF 2");
  ASSERT_TRUE(writer->Write(header));
  while (server_->room().uploads.used() == 0) std::this_thread::yield();
  revoke(id);
  while (reader->Read(&seen)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(writer->Finish().error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(get(*ada, job).error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(this->job(job).state(), v1::JOB_STATE_QUEUED) << "the job itself stays";
}

// A server that is busy with what is left of deleted jobs looks after tokens all the same.
TEST_F(AccessTest, RevokingEndsCallsWhileMuchIsTidied) {
  start();
  const std::int64_t id = add("ada", v1::ROLE_USER);
  const std::string job = submit_as("ada", "OFF 1");
  const auto ada = client("ada");
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_job(job);
  const auto reader = ada->WatchJob(&context, request);
  v1::Job seen;
  ASSERT_TRUE(reader->Read(&seen));
  const auto left = [this] {
    Database db(database_file(options_.data_dir), Database::Mode::kReadOnly);
    return db.integer("SELECT count(*) FROM erosions WHERE dropped = 1").value();
  };
  {
    Database db(database_file(options_.data_dir), Database::Mode::kReadWrite);
    Transaction transaction(db);
    for (int i = 0; i < 20'000; ++i) {
      db.run(
          "INSERT INTO erosions (mesh_sha256, params, params_key, dropped)"
          " SELECT mesh_sha256, params, params_key || ?, 1 FROM erosions WHERE dropped = 0 LIMIT 1",
          i);
    }
    transaction.commit();
  }
  const std::string other = submit("OFF 2");
  server_->store().cancel(other);
  server_->store().remove(other);
  while (left() > 19'900) std::this_thread::yield();
  revoke(id);
  while (reader->Read(&seen)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), grpc::UNAUTHENTICATED);
  EXPECT_GT(left(), 0) << "it was not waited for";
}

TEST_F(AccessTest, AWorkerWithAWorkersTokenWorks) {
  start();
  add("cluster", v1::ROLE_WORKER);
  const std::string job = submit("OFF 1");
  const FakeWorker worker(tcp("cluster"), "w", 10, 20);
  EXPECT_EQ(watch(job).state(), v1::JOB_STATE_DONE);
}

TEST_F(AccessTest, ATokenFileThatIsReplacedIsReadAgain) {
  start();
  const std::int64_t first = add("ada", v1::ROLE_USER);
  const auto ada = client("ada");
  v1::ServerInfo response;
  ASSERT_TRUE(info(*ada, &response).ok());
  revoke(first);
  EXPECT_EQ(info(*ada, &response).error_code(), grpc::UNAUTHENTICATED);
  std::filesystem::remove(file("token.ada"));
  EXPECT_EQ(info(*ada, &response).error_code(), grpc::UNAUTHENTICATED)
      << "without the file the old one is shown";
  add("ada", v1::ROLE_USER);
  EXPECT_TRUE(info(*ada, &response).ok());
}

}  // namespace
}  // namespace affskel::server
