#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "access/gate.h"
#include "access/token.h"
#include "database/database_file.h"
#include "service_fixture.h"
#include "tools/test_authority.h"
#include "wire/channel.h"

namespace affskel::server {
namespace {

/// A server with a Unix socket, a TCP address on loopback, and tokens.
class AccessTest : public ServiceTest {
 protected:
  AccessTest() { options_.listen.push_back(wire::parse_address("127.0.0.1:0")); }

  /// Adds a token beside the running server, as affskel-server token add does; returns its id.
  std::int64_t add(const std::string& owner, v1::Role role, std::optional<std::int64_t> expires_ms = {}) {
    const std::string token = new_token();
    Database db(database_file(options_.data_dir), Database::Mode::kReadWrite);
    const std::int64_t id = add_token(db, token, owner, role, unix_ms(), expires_ms);
    spit("token." + owner, token + "\n");
    return id;
  }
  void revoke(std::int64_t id) {
    Database db(database_file(options_.data_dir), Database::Mode::kReadWrite);
    revoke_token(db, id, unix_ms());
  }
  void spit(const std::string& name, const std::string& text) {
    std::ofstream(directory_.path() / name) << text;
  }
  std::string file(const std::string& name) const { return (directory_.path() / name).string(); }

  /// The TCP address, with the token that was added for this owner; "" = with none.
  std::shared_ptr<grpc::Channel> tcp(const std::string& owner, wire::AccessFiles files = {}) {
    if (!owner.empty()) files.token_file = file("token." + owner);
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return wire::make_channel(server_->addresses().back(), files, arguments);
  }
  std::unique_ptr<v1::ErosionService::Stub> client(const std::string& owner) {
    return v1::ErosionService::NewStub(tcp(owner));
  }
  std::string submit_as(const std::string& owner, const std::string& mesh,
                        const std::string& request_id = "") {
    v1::SubmitJobHeader header = submit_header(mesh);
    header.set_request_id(request_id);
    v1::SubmitJobResponse response;
    const grpc::Status status = submit_mesh(*client(owner), header, mesh, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(response.job().owner(), owner);
    return response.job().id();
  }
  grpc::Status get(v1::ErosionService::Stub& stub, const std::string& job, v1::Job* response = nullptr) {
    grpc::ClientContext context;
    v1::GetJobRequest request;
    request.set_job(job);
    v1::Job ignored;
    return stub.GetJob(&context, request, response != nullptr ? response : &ignored);
  }
  grpc::Status info(v1::ErosionService::Stub& stub, v1::ServerInfo* response) {
    grpc::ClientContext context;
    return stub.GetServerInfo(&context, {}, response);
  }
};

/// Every call of both services, by a job's id.
std::vector<std::pair<std::string, std::function<grpc::Status(const std::shared_ptr<grpc::Channel>&)>>>
all_calls(const std::string& job) {
  using Client = v1::ErosionService;
  using Worker = v1::WorkerService;
  const auto unary = [](auto method, auto request, auto response, auto make_stub) {
    return [=](const std::shared_ptr<grpc::Channel>& channel) mutable {
      grpc::ClientContext context;
      return (*make_stub(channel).*method)(&context, request, &response);
    };
  };
  const auto client = [](const std::shared_ptr<grpc::Channel>& channel) { return Client::NewStub(channel); };
  const auto worker = [](const std::shared_ptr<grpc::Channel>& channel) { return Worker::NewStub(channel); };
  const auto about = [&](auto request) {
    request.set_job(job);
    return request;
  };
  const auto leased = [&](auto request) {
    request.set_token("no lease");
    return request;
  };
  v1::LeaseTaskRequest lease;
  *lease.mutable_worker() = worker_identity();
  return {
      {"SubmitJob",
       [](const std::shared_ptr<grpc::Channel>& channel) {
         v1::SubmitJobResponse response;
         return submit_mesh(*Client::NewStub(channel), submit_header("OFF all"), "OFF all", &response);
       }},
      {"GetJob", unary(&Client::Stub::GetJob, about(v1::GetJobRequest()), v1::Job(), client)},
      {"ListJobs", unary(&Client::Stub::ListJobs, v1::ListJobsRequest(), v1::ListJobsResponse(), client)},
      {"WatchJob",
       [=](const std::shared_ptr<grpc::Channel>& channel) {
         grpc::ClientContext context;
         const auto stub = Client::NewStub(channel);
         const auto reader = stub->WatchJob(&context, about(v1::WatchJobRequest()));
         v1::Job seen;
         if (!reader->Read(&seen)) return reader->Finish();
         context.TryCancel();
         reader->Finish();
         return grpc::Status::OK;
       }},
      {"CancelJob", unary(&Client::Stub::CancelJob, about(v1::CancelJobRequest()), v1::Job(), client)},
      {"ResumeJob", unary(&Client::Stub::ResumeJob, about(v1::ResumeJobRequest()), v1::Job(), client)},
      {"PinJob", unary(&Client::Stub::PinJob, about(v1::PinJobRequest()), v1::Job(), client)},
      {"UnpinJob", unary(&Client::Stub::UnpinJob, about(v1::UnpinJobRequest()), v1::Job(), client)},
      {"DeleteJob",
       unary(&Client::Stub::DeleteJob, about(v1::DeleteJobRequest()), v1::DeleteJobResponse(), client)},
      {"ListJobEvents", unary(&Client::Stub::ListJobEvents, about(v1::ListJobEventsRequest()),
                              v1::ListJobEventsResponse(), client)},
      {"FetchArtifact",
       [=](const std::shared_ptr<grpc::Channel>& channel) {
         v1::FetchArtifactRequest request = about(v1::FetchArtifactRequest());
         request.set_kind(v1::ARTIFACT_KIND_MESH);
         return fetch(*Client::NewStub(channel), request).status;
       }},
      {"GetServerInfo",
       unary(&Client::Stub::GetServerInfo, v1::GetServerInfoRequest(), v1::ServerInfo(), client)},
      {"LeaseTask", unary(&Worker::Stub::LeaseTask, lease, v1::LeaseTaskResponse(), worker)},
      {"RenewLease",
       unary(&Worker::Stub::RenewLease, leased(v1::RenewLeaseRequest()), v1::ReportResponse(), worker)},
      {"ReportErosion",
       [](const std::shared_ptr<grpc::Channel>& channel) {
         grpc::ClientContext context;
         v1::ReportResponse response;
         const auto stub = Worker::NewStub(channel);
         const auto writer = stub->ReportErosion(&context, &response);
         v1::ReportErosionRequest message;
         message.mutable_header()->set_token("no lease");
         writer->Write(message);
         writer->WritesDone();
         return writer->Finish();
       }},
      {"CompleteTask",
       [](const std::shared_ptr<grpc::Channel>& channel) {
         v1::CompleteTaskHeader header;
         header.set_token("no lease");
         return send_result(*Worker::NewStub(channel), header, "");
       }},
      {"FailTask",
       unary(&Worker::Stub::FailTask, leased(v1::FailTaskRequest()), v1::ReportResponse(), worker)},
      {"ReturnLease",
       unary(&Worker::Stub::ReturnLease, leased(v1::ReturnLeaseRequest()), v1::ReportResponse(), worker)},
      {"FetchInput",
       [=](const std::shared_ptr<grpc::Channel>& channel) {
         grpc::ClientContext context;
         const auto stub = Worker::NewStub(channel);
         v1::FetchInputRequest request = leased(v1::FetchInputRequest());
         request.set_kind(v1::ARTIFACT_KIND_MESH);
         const auto reader = stub->FetchInput(&context, request);
         v1::FetchArtifactResponse part;
         while (reader->Read(&part)) {
         }
         return reader->Finish();
       }},
  };
}

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
    for (const auto& [name, call] : all_calls(job)) {
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
  for (const auto& [name, call] : all_calls(job)) {
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
  const auto others = all_calls(job), nobodys = all_calls(nothing);
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

/// The same over TLS.
class TlsTest : public AccessTest {
 protected:
  TlsTest() : authority_(directory_.path(), "authority"), stranger_(directory_.path(), "stranger") {
    authority_.sign("server");
    authority_.sign("client");
    options_.tls.certificate = authority_.certificate("server");
    options_.tls.key = authority_.key("server");
  }
  wire::AccessFiles trusting(const tests::TestAuthority& authority, const std::string& own = "") const {
    wire::AccessFiles files;
    files.tls_ca = authority.file();
    if (!own.empty()) {
      files.tls_cert = authority_.certificate(own);
      files.tls_key = authority_.key(own);
    }
    return files;
  }
  grpc::Status call(const wire::AccessFiles& files, const std::string& owner = "") {
    v1::ServerInfo response;
    return info(*v1::ErosionService::NewStub(tcp(owner, files)), &response);
  }

  tests::TestAuthority authority_;
  tests::TestAuthority stranger_;
};

TEST_F(TlsTest, OnlyWithTlsAndATrustedServer) {
  start();
  add("ada", v1::ROLE_USER);
  EXPECT_TRUE(call(trusting(authority_), "ada").ok());
  EXPECT_EQ(call(trusting(authority_)).error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(call(trusting(stranger_), "ada").error_code(), grpc::UNAVAILABLE);
  EXPECT_EQ(call({}, "ada").error_code(), grpc::UNAVAILABLE) << "in the clear";
  v1::ServerInfo response;
  EXPECT_TRUE(info(*client_, &response).ok()) << "the Unix socket needs none";
}

TEST_F(TlsTest, ConnectionsAreInTheTableAsOthersAre) {
  start();
  const std::string job = submit("OFF 1");
  add("ada", v1::ROLE_ADMIN);
  const std::size_t others = server_->room().connections.size();
  const auto stub = v1::ErosionService::NewStub(tcp("ada", trusting(authority_)));
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_job(job);
  const auto reader = stub->WatchJob(&context, request);
  v1::Job seen;
  ASSERT_TRUE(reader->Read(&seen));
  EXPECT_EQ(server_->room().connections.size(), others + 1);
  // Only a connection that is found in the table has its calls counted there.
  while (server_->room().connections.calls() != 1) std::this_thread::yield();
  context.TryCancel();
  reader->Finish();
}

TEST_F(TlsTest, ClientCertificatesAreAskedForAndVerified) {
  options_.tls.client_ca = authority_.file();
  start();
  add("ada", v1::ROLE_USER);
  EXPECT_TRUE(call(trusting(authority_, "client"), "ada").ok());
  const grpc::Status without = call(trusting(authority_), "ada");
  EXPECT_EQ(without.error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(without.error_message(), "this server asks for a client certificate");
  stranger_.sign("strange");
  EXPECT_EQ(call(trusting(authority_, "strange"), "ada").error_code(), grpc::UNAVAILABLE);
  EXPECT_EQ(call(trusting(authority_, "client")).error_code(), grpc::UNAUTHENTICATED)
      << "a token all the same";
}

TEST_F(TlsTest, ReplacedCertificatesAreUsedWithoutARestart) {
  start();
  ASSERT_TRUE(call(trusting(authority_)).ok());
  stranger_.sign("server");
  while (!call(trusting(stranger_)).ok()) std::this_thread::yield();
  EXPECT_EQ(call(trusting(authority_)).error_code(), grpc::UNAVAILABLE);
}

TEST_F(TlsTest, FilesThatAreNoGoodAreNamed) {
  spit("rubbish.pem", "rubbish");
  const auto error_with = [&](const TlsOptions& tls) {
    options_.tls = tls;
    try {
      start();
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const TlsOptions good = options_.tls;
  for (std::string TlsOptions::*member :
       {&TlsOptions::certificate, &TlsOptions::key, &TlsOptions::client_ca}) {
    for (const char* name : {"rubbish.pem", "absent.pem"}) {
      TlsOptions bad = good;
      bad.*member = file(name);
      EXPECT_NE(error_with(bad).find(file(name)), std::string::npos) << error_with(bad);
    }
  }
  TlsOptions mixed = good;
  mixed.key = authority_.key("client");
  EXPECT_NE(error_with(mixed).find("not that of the certificate"), std::string::npos);
}

}  // namespace
}  // namespace affskel::server
