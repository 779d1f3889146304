// Submissions of clients that send slowly, or nothing, and calls that come after them.
#include <list>

#include "service_fixture.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kNeverUploaded{24 * 3600 * 1000};

/// A submission under way.
struct Uploading {
  grpc::ClientContext context;
  v1::SubmitJobResponse response;
  std::unique_ptr<grpc::ClientWriter<v1::SubmitJobRequest>> writer;

  Uploading(v1::ErosionService::Stub& stub, bool with_header) {
    writer = stub.SubmitJob(&context, &response);
    if (!with_header) return;
    v1::SubmitJobRequest message;
    *message.mutable_header() = submit_header("OFF which is yet to come");
    writer->Write(message);
  }
};

TEST_F(ServiceTest, SlowUploadsKeepNoPlaceThatOthersNeed) {
  options_.limits.uploads = 4;
  options_.limits.receiving = {.first = kNeverUploaded, .window = kNeverUploaded, .trial = milliseconds(0)};
  options_.limits.receiving.least_per_s = std::uint64_t{1} << 40;
  start();
  std::list<Uploading> slow;
  for (int i = 0; i < 4; ++i) slow.emplace_back(*client_, true);
  while (server_->room().uploads.used() < 4) std::this_thread::yield();
  v1::SubmitJobResponse response;
  grpc::Status status(grpc::StatusCode::UNAVAILABLE, "");
  // One whose header is being looked at is not slow.
  while (status.error_code() == grpc::StatusCode::UNAVAILABLE) {
    status = submit_mesh(*client_, submit_header("OFF 1"), "OFF 1", &response);
  }
  EXPECT_TRUE(status.ok()) << status.error_message();
  for (Uploading& one : slow) one.context.TryCancel();
  for (Uploading& one : slow) EXPECT_FALSE(one.writer->Finish().ok());
}

TEST_F(ServiceTest, AnUploadThatNeverBeginsIsEnded) {
  options_.limits.receiving.first = milliseconds(50);
  start();
  Uploading silent(*client_, false);
  const grpc::Status status = silent.writer->Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_NE(status.error_message().find("too little"), std::string::npos) << status.error_message();
}

TEST_F(ServiceTest, AnUploadThatStandsStillIsEnded) {
  options_.limits.receiving.window = milliseconds(50);
  start();
  Uploading stuck(*client_, true);
  EXPECT_EQ(stuck.writer->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(ServiceTest, StoppingDoesNotWaitForSlowUploads) {
  std::list<Uploading> slow;
  for (int i = 0; i < 50; ++i) slow.emplace_back(*client_, i % 2 == 0);
  while (server_->room().uploads.used() < 50) std::this_thread::yield();
  server_->stop(milliseconds(20));
  for (Uploading& one : slow) EXPECT_FALSE(one.writer->Finish().ok());
}

}  // namespace
}  // namespace affskel::server
