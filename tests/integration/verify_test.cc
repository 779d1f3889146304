// A worker that lies, among real ones: it is found and named, and what it gave is mended.
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <optional>

#include "affskel/v1/worker_service.grpc.pb.h"
#include "lab.h"
#include "terminal.h"
#include "wire/direction_order.h"
#include "wire/limits.h"

namespace affskel::integration {
namespace {

constexpr const char* kLiar = "11111111111111111111111111111111";

/// Speaks the workers' protocol, and tells what it likes.
class LyingWorker {
 public:
  LyingWorker(const std::string& address, std::string core_version)
      : stub_(v1::WorkerService::NewStub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()))),
        core_version_(std::move(core_version)) {}

  grpc::Status lease(v1::Lease& lease) {
    v1::LeaseTaskRequest request;
    v1::WorkerIdentity& worker = *request.mutable_worker();
    worker.set_id(kLiar);
    worker.set_host("broken-host");
    worker.set_pid(1);
    worker.set_threads(1);
    worker.set_core_version(core_version_);
    request.set_wait_ms(10000);
    grpc::ClientContext context;
    v1::LeaseTaskResponse response;
    const grpc::Status status = stub_->LeaseTask(&context, request, &response);
    lease = response.lease();
    return status;
  }

  /// The whole block as done, with `erosion` at every point under its first direction; of no points at all
  /// when it is not given.
  grpc::Status report(const v1::Lease& lease, std::optional<double> erosion) {
    grpc::ClientContext context;
    v1::ReportResponse response;
    const auto writer = stub_->ReportErosion(&context, &response);
    v1::ReportErosionRequest message;
    message.mutable_header()->set_token(lease.token());
    *message.mutable_header()->mutable_positions_done() = lease.positions();
    message.mutable_header()->set_block_done(true);
    writer->Write(message);
    const auto points = static_cast<std::uint32_t>(erosion ? lease.job().prepared().points() : 0);
    const auto direction = static_cast<std::uint32_t>(wire::direction_at(
        lease.positions(0).begin(), lease.job().order_stride(), lease.job().directions_total()));
    for (std::uint32_t point = 0; point < points;) {
      v1::FieldRecords& records = *message.mutable_records();
      for (records.Clear(); point < points && records.point_size() < wire::kRecordsPerMessage; ++point) {
        records.add_point(point);
        records.add_direction(direction);
        records.add_erosion(*erosion);
        records.add_area(1);
      }
      writer->Write(message);
    }
    writer->WritesDone();
    return writer->Finish();
  }

 private:
  std::unique_ptr<v1::WorkerService::Stub> stub_;
  std::string core_version_;
};

class VerifyTest : public testing::Test {
 protected:
  static std::string submit(const Lab& lab) {
    lab.make_torus(512);
    return lab.submit({"--points", "20000", "--directions", "random:2000:1"});
  }

  static std::string field(const Lab& lab, const std::string& job) {
    EXPECT_EQ(lab.client({"fetch", job, "field", "-o", lab.path("field.dat")}).exit_code, 0);
    return lab.read("field.dat");
  }

  static std::string honest_field() {
    const Lab lab;
    const Process server = lab.server({"--workers", "1"});
    const std::string job = submit(lab);
    lab.follow_to_end(job);
    return field(lab, job);
  }

  /// The server's own worker leaves, or, against what is expected, finishes the job.
  void wait_for_no_successor(const std::string& job) const {
    while (lab_.read("server.log").find("none is started in its place") == std::string::npos)
      ASSERT_NE(lab_.job(job).state(), v1::JOB_STATE_DONE);
  }

  /// Submits and prepares the job by a real worker, which leaves; then the liar takes its first block.
  std::string begin_with_lie(std::optional<double> share_of_volume) {
    const std::string job = submit(lab_);
    v1::Job prepared;
    {
      Process worker = lab_.worker({"--threads", "1"});
      prepared = lab_.follow(job, [](const v1::Job& j) { return j.directions_total() > 0; });
      worker.send(SIGTERM);
      worker.wait();
    }
    EXPECT_LT(lab_.job(job).directions_done(), prepared.directions_total());
    liar_ = std::make_unique<LyingWorker>(lab_.address(), prepared.core_version());
    v1::Lease lease;
    EXPECT_TRUE(liar_->lease(lease).ok());
    EXPECT_EQ(lease.kind(), v1::TASK_KIND_ERODE);
    std::optional<double> erosion;
    if (share_of_volume) {
      const double volume = prepared.prepared().volume();
      EXPECT_EQ(liar_->report(lease, 0.0).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
      EXPECT_EQ(liar_->report(lease, 2 * volume).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
      erosion = *share_of_volume * volume;
    }
    EXPECT_TRUE(liar_->report(lease, erosion).ok());
    return job;
  }

  Lab lab_;
  std::unique_ptr<LyingWorker> liar_;
};

TEST_F(VerifyTest, TooSmallValuesAreFoundAndMended) {
  const std::string honest = honest_field();
  const Process server = lab_.server();
  const std::string job = begin_with_lie(1e-6);
  const Process first = lab_.worker({"--threads", "1"}), second = lab_.worker({"--threads", "1"});
  ASSERT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
  EXPECT_NE(field(lab_, job), honest);

  const Output found = lab_.client({"verify", job});
  EXPECT_EQ(found.exit_code, 1) << found.out << found.err;
  EXPECT_NE(found.out.find(std::string(kLiar) + " on broken-host"), std::string::npos) << found.out;
  const std::string mend =
      "affskel-client --server " + lab_.address() + " resume " + job + " --distrust " + kLiar;
  EXPECT_NE(found.err.find(mend), std::string::npos) << found.err;
  EXPECT_NE(lab_.client({"log", job}).out.find(std::string("given by ") + kLiar), std::string::npos);

  EXPECT_EQ(lab_.client({"resume", job, "--distrust", "broken-host"}).exit_code, 0);
  ASSERT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(field(lab_, job), honest);
  // Both have computed most directions by now, before the lie came out and after it.
  const Process third = lab_.worker({"--threads", "1"});
  const Output clean = lab_.client({"verify", job, "--share", "2%"});
  EXPECT_EQ(clean.exit_code, 0) << clean.out << clean.err;
  v1::Lease lease;
  EXPECT_EQ(liar_->lease(lease).error_code(), grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(lab_.run({AFFSKEL_SERVER_BINARY, "check", "--data-dir", lab_.path("data")}).exit_code, 0);
}

TEST_F(VerifyTest, CtrlCLeavesTheCommandThatFollowsIt) {
  const Process server = lab_.server();
  lab_.make_torus(100);
  std::string job;
  {
    const Process worker = lab_.worker({"--threads", "1"});
    job = lab_.submit({"--points", "500"});
    ASSERT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
  }
  const std::string client = std::string(AFFSKEL_CLIENT_BINARY) + " --server " + lab_.address();
  Terminal verify(client + " verify " + job + " --share 10%");
  verify.read_until("waits: ");
  verify.type("\x03");
  const std::string text = verify.read_all();
  EXPECT_NE(text.find("follow it again with: affskel-client --server " + lab_.address() + " verify " + job +
                      " --share 0.1\r\n"),
            std::string::npos)
      << text;
}

TEST_F(VerifyTest, SilenceIsFoundAndMended) {
  const std::string honest = honest_field();
  const Process server = lab_.server();
  const std::string job = begin_with_lie(std::nullopt);
  const Process first = lab_.worker({"--threads", "1"}), second = lab_.worker({"--threads", "1"});
  ASSERT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
  EXPECT_NE(field(lab_, job), honest);
  const Output found = lab_.client({"verify", job, "--share", "10%"});
  EXPECT_EQ(found.exit_code, 1) << found.out << found.err;
  EXPECT_NE(found.err.find(kLiar), std::string::npos) << found.err;
  EXPECT_EQ(lab_.client({"resume", job, "--distrust", std::string(kLiar).substr(0, 12)}).exit_code, 0);
  ASSERT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(field(lab_, job), honest);
}

// A worker that the server itself supervises: another one is not started on the same machine.
TEST_F(VerifyTest, ADistrustedHostHasNoWorkersUntilItIsTrustedAgain) {
  lab_.make_torus(100);
  std::string job, host;
  {
    const Process server = lab_.server({"--workers", "1"});
    job = lab_.submit({"--points", "500"});
    ASSERT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
    const v1::Giver giver = lab_.only_giver(job);
    host = giver.host();
    const Output answer = lab_.client({"resume", job, "--distrust", host});
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    EXPECT_NE(answer.err.find("until affskel-server trust"), std::string::npos) << answer.err;
    wait_for_no_successor(job);
    Process another = lab_.worker({"--threads", "1", "--idle-exit", "1"});
    EXPECT_EQ(another.wait(), 7);
    EXPECT_EQ(lab_.job(job).state(), v1::JOB_STATE_QUEUED);
    EXPECT_NE(lab_.client({"log", job}).out.find("no worker of host '" + host + "' gets work"),
              std::string::npos);
  }
  const std::vector<std::string> trust = {AFFSKEL_SERVER_BINARY, "trust", host, "--data-dir",
                                          lab_.path("data")};
  {
    const Process server = lab_.server({"--workers", "1"});
    Process another = lab_.worker({"--threads", "1", "--idle-exit", "1"});
    EXPECT_EQ(another.wait(), 7);
    const Output trusted = lab_.run(trust);
    EXPECT_EQ(trusted.exit_code, 0) << trusted.err;
    Process free = lab_.worker({"--threads", "1", "--idle-exit", "1"});
    EXPECT_EQ(free.wait(), 0) << "beside the server that runs";
  }
  const Output twice = lab_.run(trust);
  EXPECT_EQ(twice.exit_code, 4) << twice.err;
  const Process server = lab_.server({"--workers", "1"});
  EXPECT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
}

// By its id: the next would have another, and the same machine.
TEST_F(VerifyTest, ADistrustedWorkerOfTheServersOwnHasNoSuccessorBeforeTheServerIsStartedAnew) {
  lab_.make_torus(100);
  std::string job;
  {
    const Process server = lab_.server({"--workers", "1"});
    job = lab_.submit({"--points", "500"});
    ASSERT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
    const v1::Giver giver = lab_.only_giver(job);
    EXPECT_EQ(lab_.client({"resume", job, "--distrust", giver.worker()}).exit_code, 0);
    wait_for_no_successor(job);
  }
  const Process server = lab_.server({"--workers", "1"});
  EXPECT_EQ(lab_.follow_to_end(job).state(), v1::JOB_STATE_DONE);
}

}  // namespace
}  // namespace affskel::integration
