// Downloads of clients that read slowly, or nothing, and calls that come after them.
#include "service_fixture.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kNever{24 * 3600 * 1000};

/// A server with one place for downloads, and a job whose mesh is more than connections hold on their way.
class OneDownload : public ServiceTest {
 protected:
  /// @param trial after which a download may be called slow.
  void start_with(milliseconds patience, milliseconds trial, std::uint64_t least_per_s) {
    options_.limits.downloads = 1;
    options_.limits.patience = patience;
    options_.limits.sending.first = options_.limits.sending.window = kNever;
    options_.limits.sending.trial = trial;
    options_.limits.sending.least_per_s = least_per_s;
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
  start_with(milliseconds(0), kNever, 1);
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
  start_with(kNever, kNever, 1);
  stall();
  context_.TryCancel();
  stalled_->Finish();
  EXPECT_EQ(fetch_again().data, mesh_);
}

TEST_F(OneDownload, WhoReadsTooSlowlyLosesItsPlaceToOthers) {
  start_with(milliseconds(0), milliseconds(0), std::uint64_t{1} << 40);
  stall();
  Fetched second = fetch_again();
  // Until the first one is stuck it is not its reader's turn.
  while (second.status.error_code() == grpc::StatusCode::UNAVAILABLE) second = fetch_again();
  EXPECT_EQ(second.data, mesh_);
  v1::FetchArtifactResponse message;
  while (stalled_->Read(&message)) {
  }
  // The reason comes through when the stream has room for it by then.
  const grpc::Status ended = stalled_->Finish();
  EXPECT_TRUE(ended.error_code() == grpc::StatusCode::CANCELLED ||
              ended.error_message().find("the call was ended: ") != std::string::npos)
      << ended.error_code() << ' ' << ended.error_message();
}

TEST_F(ServiceTest, WhoReadsNothingIsEnded) {
  options_.limits.sending.first = options_.limits.sending.window = milliseconds(300);
  options_.limits.sending.least_per_s = std::uint64_t{1} << 40;
  start();
  const std::string id = submit(std::string(std::size_t{24} << 20, 'm'));
  grpc::ClientContext context;
  const auto reader = client_->FetchArtifact(&context, mesh_request(id));
  while (server_->room().downloads.used() == 0) std::this_thread::yield();
  while (server_->room().downloads.used() > 0) std::this_thread::yield();
  v1::FetchArtifactResponse message;
  while (reader->Read(&message)) {
  }
  // The call ends, or with it the connection, by which is heard first.
  const grpc::StatusCode code = reader->Finish().error_code();
  EXPECT_TRUE(code == grpc::StatusCode::CANCELLED || code == grpc::StatusCode::UNAVAILABLE) << code;
}

}  // namespace
}  // namespace affskel::server
