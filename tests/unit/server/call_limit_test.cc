#include "rpc/call_limit.h"

#include <fcntl.h>
#include <poll.h>
#include <sqlite3.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

#include "database/sqlite.h"
#include "rpc/status.h"
#include "service_fixture.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

TEST(CallLimitsTest, AlwaysLeaveDescriptorsToWorkersAndTheDatabase) {
  for (const std::uint64_t open_files : {16U, 64U, 256U, 1024U, 4096U, 1048576U, 0xFFFFFFFFU}) {
    const CallLimits limits = limits_for(open_files);
    EXPECT_GE(limits.downloads, 1U) << open_files;
    EXPECT_LE(limits.downloads, 64U) << open_files;
    EXPECT_GE(limits.connections, 1) << open_files;
    // Downloads take two each, and as many are left beyond them.
    EXPECT_LE(static_cast<std::uint64_t>(limits.connections) + 2 * limits.downloads +
                  std::min<std::uint64_t>(128, open_files / 8),
              open_files)
        << open_files;
  }
}

TEST(CallLimitTest, RefusesMoreAndNamesTheLimit) {
  CallLimit limit("downloads", 2, milliseconds(0), milliseconds(0));
  const auto enter = [&] { return guarded([&] { const CallLimit::Place place(limit); }); };
  const CallLimit::Place first(limit);
  EXPECT_TRUE(enter().ok());
  {
    const CallLimit::Place second(limit);
    const grpc::Status refused = enter();
    EXPECT_EQ(refused.error_code(), grpc::StatusCode::UNAVAILABLE);
    EXPECT_NE(refused.error_message().find("2 downloads"), std::string::npos) << refused.error_message();
  }
  EXPECT_TRUE(enter().ok()) << "a place that was left is free";
}

TEST(CallLimitTest, WaitsForItsTurn) {
  CallLimit limit("downloads", 1, milliseconds(600000), milliseconds(600000));
  std::optional<CallLimit::Place> first(std::in_place, limit);
  std::thread second([&] { const CallLimit::Place place(limit); });
  first.reset();
  second.join();
}

v1::FetchArtifactRequest mesh_request(const std::string& job) {
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(v1::ARTIFACT_KIND_MESH);
  return request;
}

/// A server with one place for downloads, and a job whose mesh is more than connections hold on their way.
class OneDownload : public ServiceTest {
 protected:
  void start_with(milliseconds patience, milliseconds stall) {
    options_.limits.downloads = 1;
    options_.limits.patience = patience;
    options_.limits.stall = stall;
    start();
    job_ = submit(mesh_);
  }

  /// A download of which nothing but the header is read.
  void stall() {
    stalled_ = client_->FetchArtifact(&context_, mesh_request(job_));
    v1::FetchArtifactResponse message;
    ASSERT_TRUE(stalled_->Read(&message));
  }

  Fetched fetch_again() { return fetch(*client_, mesh_request(job_)); }

  const std::string mesh_ = std::string(std::size_t{24} << 20, 'm');
  std::string job_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::FetchArtifactResponse>> stalled_;
};

TEST_F(OneDownload, RefusesAnotherButServesAllElse) {
  start_with(milliseconds(0), milliseconds(600000));
  stall();
  const grpc::Status refused = fetch_again().status;
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_NE(refused.error_message().find("1 downloads"), std::string::npos) << refused.error_message();
  EXPECT_EQ(job(job_).state(), v1::JOB_STATE_QUEUED);

  // A worker's input is no download of a client.
  const v1::LeaseTaskResponse leased = poll(10000);
  ASSERT_TRUE(leased.has_lease());
  grpc::ClientContext context;
  v1::FetchInputRequest request;
  request.set_token(leased.lease().token());
  request.set_kind(v1::ARTIFACT_KIND_MESH);
  const auto reader = worker_->FetchInput(&context, request);
  std::string input;
  for (v1::FetchArtifactResponse message; reader->Read(&message);) input += message.data();
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(input, mesh_);
  context_.TryCancel();
  stalled_->Finish();
}

TEST_F(OneDownload, TheNextBeginsWhenItEnds) {
  start_with(milliseconds(600000), milliseconds(600000));
  stall();
  context_.TryCancel();
  stalled_->Finish();
  EXPECT_EQ(fetch_again().data, mesh_);
}

TEST_F(OneDownload, WhoStandsStillLosesItsPlace) {
  start_with(milliseconds(0), milliseconds(0));
  stall();
  EXPECT_EQ(fetch_again().data, mesh_);
  v1::FetchArtifactResponse message;
  while (stalled_->Read(&message)) {
  }
  EXPECT_EQ(stalled_->Finish().error_code(), grpc::StatusCode::CANCELLED);
}

TEST_F(ServiceTest, MoreWatchesThanThereMayBeAreRefused) {
  options_.limits.watches = 1;
  start();
  v1::WatchJobRequest request;
  request.set_job(submit());
  grpc::ClientContext first_context, second_context;
  const auto first = client_->WatchJob(&first_context, request);
  v1::Job job;
  ASSERT_TRUE(first->Read(&job));
  const auto second = client_->WatchJob(&second_context, request);
  EXPECT_FALSE(second->Read(&job));
  EXPECT_EQ(second->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
  first_context.TryCancel();
  first->Finish();
}

/// Connections that say nothing.
class Idlers {
 public:
  explicit Idlers(const std::string& path, int count) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, path.data(), path.size());
    for (int i = 0; i < count; ++i) {
      fds_.push_back({socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0), POLLRDHUP, 0});
      EXPECT_EQ(connect(fds_.back().fd, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
    }
  }
  ~Idlers() {
    for (const pollfd& one : fds_) close(one.fd);
  }
  /// Returns when one of them was hung up on.
  void wait_for_refusal() { EXPECT_GT(::poll(fds_.data(), fds_.size(), -1), 0); }

 private:
  std::vector<pollfd> fds_;
};

TEST_F(ServiceTest, ListensOnAfterTooManyConnections) {
  const int lowest = dup(0);
  close(lowest);
  options_.limits.connections = lowest + 60;
  start();
  const std::string id = submit();
  {
    Idlers idlers(options_.data_dir + "/server.sock", 100);
    idlers.wait_for_refusal();
    EXPECT_EQ(job(id).state(), v1::JOB_STATE_QUEUED) << "who is connected stays so";
  }
  const auto later = v1::ErosionService::NewStub(connect());
  grpc::ClientContext context;
  context.set_wait_for_ready(true);
  v1::ServerInfo info;
  EXPECT_TRUE(later->GetServerInfo(&context, {}, &info).ok());
}

int out_of_files(const char*, int, int) {
  errno = EMFILE;
  return -1;
}

TEST(OutOfFilesTest, IsNoErrorOfTheDatabaseButOneToTryAgain) {
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "db").string();
  Database(file, Database::Mode::kReadWrite).execute("CREATE TABLE t (a INTEGER) STRICT");
  sqlite3_vfs* const vfs = sqlite3_vfs_find(nullptr);
  vfs->xSetSystemCall(vfs, "open", reinterpret_cast<sqlite3_syscall_ptr>(out_of_files));
  const grpc::Status status = guarded([&] { const Database refused(file, Database::Mode::kReadOnly); });
  vfs->xSetSystemCall(vfs, nullptr, nullptr);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(status.error_message().find(file), std::string::npos) << status.error_message();
}

}  // namespace
}  // namespace affskel::server
