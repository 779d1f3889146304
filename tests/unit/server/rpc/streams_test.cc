// Streams of peers that are slow, many, or gone.
#include <sqlite3.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <list>

#include "database/sqlite.h"
#include "rpc/status.h"
#include "service_fixture.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kNever{24 * 3600 * 1000};

v1::FetchArtifactRequest mesh_request(const std::string& job) {
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(v1::ARTIFACT_KIND_MESH);
  return request;
}

v1::FetchArtifactRequest skeleton_request(const std::string& job, double threshold) {
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(v1::ARTIFACT_KIND_SKELETON);
  request.mutable_skeleton()->set_threshold(threshold);
  return request;
}

/// Of this process, the client's and gRPC's included.
int thread_count() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "Threads:") continue;
    int count = 0;
    status >> count;
    return count;
  }
  return -1;
}

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
  EXPECT_EQ(stalled_->Finish().error_code(), grpc::StatusCode::CANCELLED);
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
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
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
  options_.limits.receiving = {.first = kNever, .window = kNever, .trial = milliseconds(0)};
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

TEST_F(ServiceTest, StreamsHoldNoThreads) {
  std::vector<std::unique_ptr<v1::WorkerService::Stub>> stubs;
  for (int i = 0; i < 4; ++i) stubs.push_back(v1::WorkerService::NewStub(connect()));
  poll(0);
  const int before = thread_count();
  struct Report {
    grpc::ClientContext context;
    v1::ReportResponse response;
    std::unique_ptr<grpc::ClientWriter<v1::ReportErosionRequest>> writer;
  };
  std::list<Report> reports;
  for (std::size_t i = 0; i < 600; ++i) {
    Report& report = reports.emplace_back();
    report.writer = stubs[i % stubs.size()]->ReportErosion(&report.context, &report.response);
  }
  while (server_->room().reports.used() < 600) std::this_thread::yield();
  EXPECT_LT(thread_count(), before + 20);
  EXPECT_FALSE(poll(0).has_lease()) << "all else is served";
  for (Report& report : reports) report.context.TryCancel();
  for (Report& report : reports) report.writer->Finish();
}

class ReportStreams : public ServiceTest {
 protected:
  v1::Lease block(std::uint32_t points, std::uint32_t directions) {
    submit();
    const PrepareResult result = prepare_result(poll(0).lease().token(), points, directions);
    EXPECT_TRUE(send_result(*worker_, result.header, result.data).ok());
    return poll(0).lease();
  }

  static v1::ReportErosionRequest header(const v1::Lease& lease, std::uint64_t records) {
    v1::ReportErosionRequest message;
    message.mutable_header()->set_token(lease.token());
    v1::PositionRange& range = *message.mutable_header()->add_positions_done();
    range.set_begin(0);
    range.set_end(1);
    message.mutable_header()->set_records(records);
    return message;
  }

  /// As many records as a message may have, of the first points.
  static v1::ReportErosionRequest records(std::uint32_t points, double erosion) {
    v1::ReportErosionRequest message;
    for (std::uint32_t i = 0; i < 32768; ++i) {
      message.mutable_records()->add_point(i % points);
      message.mutable_records()->add_direction(0);
      message.mutable_records()->add_erosion(erosion);
      message.mutable_records()->add_area(1);
    }
    return message;
  }

  /// E of the first point, as merged so far.
  double first_erosion(const v1::Lease& lease) {
    grpc::ClientContext context;
    v1::FetchInputRequest request;
    request.set_token(lease.token());
    request.set_kind(v1::ARTIFACT_KIND_FIELD);
    const auto reader = worker_->FetchInput(&context, request);
    std::string field;
    for (v1::FetchArtifactResponse message; reader->Read(&message);) field += message.data();
    EXPECT_TRUE(reader->Finish().ok());
    double erosion = -1;
    if (field.size() >= sizeof erosion) std::memcpy(&erosion, field.data(), sizeof erosion);
    return erosion;
  }
};

TEST_F(ReportStreams, AreMergedInPartsAndCountOnlyWhenComplete) {
  const v1::Lease lease = block(4000, 40);
  EXPECT_TRUE(std::isinf(first_erosion(lease)));
  grpc::ClientContext context;
  v1::ReportResponse response;
  const auto writer = worker_->ReportErosion(&context, &response);
  ASSERT_TRUE(writer->Write(header(lease, 0)));
  // One more than are held: the fifth finds the batch full.
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(writer->Write(records(4000, 9.0 - i)));
  while (std::isinf(first_erosion(lease))) std::this_thread::yield();
  EXPECT_EQ(first_erosion(lease), 6.0) << "four of five are merged";
  context.TryCancel();
  writer->Finish();
  EXPECT_EQ(job(lease.job().id()).directions_done(), 0U);
}

TEST_F(ReportStreams, AreCountedOverAllParts) {
  const v1::Lease lease = block(4000, 40);
  const auto report = [&](std::uint64_t announced) {
    grpc::ClientContext context;
    v1::ReportResponse response;
    const auto writer = worker_->ReportErosion(&context, &response);
    writer->Write(header(lease, announced));
    for (int i = 0; i < 6; ++i) writer->Write(records(4000, 9.0 - i));
    writer->WritesDone();
    return writer->Finish();
  };
  EXPECT_EQ(report(6 * 32768 + 1).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(job(lease.job().id()).directions_done(), 0U);
  const grpc::Status complete = report(6 * 32768);
  EXPECT_TRUE(complete.ok()) << complete.error_message();
  EXPECT_EQ(job(lease.job().id()).directions_done(), 1U);
  EXPECT_EQ(first_erosion(lease), 4.0);
}

TEST_F(ReportStreams, TogetherHoldNoMoreThanTheirBudget) {
  options_.limits.records_bytes = 40000 * sizeof(wire::PointRecord);
  start();
  const v1::Lease lease = block(4000, 40);
  grpc::ClientContext contexts[2];
  v1::ReportResponse response;
  std::unique_ptr<grpc::ClientWriter<v1::ReportErosionRequest>> writers[2];
  for (int i = 0; i < 2; ++i) {
    writers[i] = worker_->ReportErosion(&contexts[i], &response);
    ASSERT_TRUE(writers[i]->Write(header(lease, 0)));
    ASSERT_TRUE(writers[i]->Write(records(4000, 9.0)));
  }
  ASSERT_TRUE(writers[1]->Write(records(4000, 8.0)));
  while (std::isinf(first_erosion(lease))) std::this_thread::yield();
  for (int i = 0; i < 2; ++i) {
    contexts[i].TryCancel();
    writers[i]->Finish();
  }
}

/// A finished job, and nobody to derive anything from it.
class WaitingRequests : public ServiceTest {
 protected:
  std::string finished_job() {
    const FakeWorker worker(connect(), "worker-a", 10, 20);
    const std::string id = submit();
    watch(id);
    return id;
  }

  /// A request that waits in a thread of its own.
  struct Waiting {
    Waiting(std::shared_ptr<grpc::Channel> channel, const std::string& id, double threshold)
        : stub(v1::ErosionService::NewStub(std::move(channel))), thread([this, id, threshold] {
            fetched = fetch(*stub, skeleton_request(id, threshold), &context);
          }) {}
    ~Waiting() {
      context.TryCancel();
      if (thread.joinable()) thread.join();
    }
    grpc::ClientContext context;
    std::unique_ptr<v1::ErosionService::Stub> stub;
    Fetched fetched;
    std::thread thread;
  };

  void wait_for_waiting(std::size_t count) {
    while (server_->room().waiting.used() != count) std::this_thread::yield();
  }
  std::int64_t requests() { return server_->store().counts().requests; }
};

TEST_F(WaitingRequests, AreBoundedAndStoredArtefactsAreNot) {
  options_.limits.waiting = 4;
  start();
  const std::string id = finished_job();
  const Waiting first(connect(), id, 1), second(connect(), id, 2);
  wait_for_waiting(2);
  const Fetched refused = fetch(*client_, skeleton_request(id, 3));
  EXPECT_EQ(refused.status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(refused.status.error_message().find("2 requests"), std::string::npos)
      << refused.status.error_message();
  EXPECT_TRUE(fetch(*client_, mesh_request(id)).status.ok());
  while (requests() != 2) std::this_thread::yield();
}

TEST_F(WaitingRequests, LeaveWithTheLastWhoAsked) {
  const std::string id = finished_job();
  {
    const Waiting second(connect(), id, 3);
    {
      const Waiting first(connect(), id, 3);
      wait_for_waiting(2);
      EXPECT_EQ(requests(), 1);
    }
    wait_for_waiting(1);
    EXPECT_EQ(requests(), 1);
  }
  wait_for_waiting(0);
  while (requests() > 0) std::this_thread::yield();
}

TEST_F(WaitingRequests, ComingAndGoingLosesNone) {
  const std::string id = finished_job();
  for (int round = 0; round < 20; ++round) {
    auto first = std::make_unique<Waiting>(connect(), id, 3);
    wait_for_waiting(1);
    // One comes in the moment in which the other goes.
    const Waiting second(connect(), id, 3);
    first.reset();
    wait_for_waiting(1);
    while (requests() != 1) std::this_thread::yield();
  }
  const Waiting last(connect(), id, 3);
  const FakeWorker worker(connect(), "worker-a", 10, 20);
  while (server_->room().waiting.used() > 0) std::this_thread::yield();
}

TEST_F(WaitingRequests, EndWhenTheServerCloses) {
  const std::string id = finished_job();
  Waiting waiting(connect(), id, 3);
  wait_for_waiting(1);
  server_->drain();
  waiting.thread.join();
  EXPECT_EQ(waiting.fetched.status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(requests(), 1) << "the next server decides";
}

TEST_F(ServiceTest, ADrainingServerTakesNoNewStreamsOfClients) {
  const std::string id = submit();
  server_->drain();
  v1::SubmitJobResponse response;
  EXPECT_EQ(submit_mesh(*client_, submit_header("OFF 2"), "OFF 2", &response).error_code(),
            grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(fetch(*client_, mesh_request(id)).status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_QUEUED) << "short calls are answered to the end";
}

TEST_F(ServiceTest, StoppingDoesNotWaitForSlowUploads) {
  std::list<Uploading> slow;
  for (int i = 0; i < 50; ++i) slow.emplace_back(*client_, i % 2 == 0);
  while (server_->room().uploads.used() < 50) std::this_thread::yield();
  server_->stop(milliseconds(20));
  for (Uploading& one : slow) EXPECT_FALSE(one.writer->Finish().ok());
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
