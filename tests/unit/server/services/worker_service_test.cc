#include <sys/wait.h>
#include <unistd.h>

#include <future>
#include <list>

#include "database/sqlite.h"
#include "service_fixture.h"
#include "wire/identity.h"

namespace affskel::server {
namespace {

class WorkerServiceTest : public ServiceTest {
 protected:
  /// A leased block of a new job.
  v1::Lease block(std::uint32_t points = 10, std::uint32_t directions = 40) {
    submit();
    const PrepareResult result = prepare_result(poll(0).lease().token(), points, directions);
    EXPECT_TRUE(send_result(*worker_, result.header, result.data).ok());
    return poll(0).lease();
  }
};

TEST_F(WorkerServiceTest, NoWorkIsAnEmptyAnswer) {
  EXPECT_FALSE(poll(0).has_lease());
}

TEST_F(WorkerServiceTest, WaitingWorkerGetsWorkWhenItComes) {
  std::future<v1::LeaseTaskResponse> answer = std::async(std::launch::async, [this] { return poll(30000); });
  wait_for_workers(1);
  const std::string id = submit();
  const v1::LeaseTaskResponse response = answer.get();
  ASSERT_TRUE(response.has_lease());
  EXPECT_EQ(response.lease().job().id(), id);
}

TEST_F(WorkerServiceTest, WaitEndsByItself) {
  EXPECT_FALSE(poll(20).has_lease());
}

TEST_F(WorkerServiceTest, WaitingWorkersShareTheBlocks) {
  std::list<std::future<v1::LeaseTaskResponse>> answers;
  const v1::Lease first = block(10, 64);
  for (const char* id : {"worker-b", "worker-c", "worker-d"}) {
    answers.push_back(std::async(std::launch::async, [this, id] { return poll(30000, id); }));
  }
  for (auto& answer : answers) EXPECT_EQ(answer.get().lease().kind(), v1::TASK_KIND_ERODE);
}

TEST_F(WorkerServiceTest, ARequestGoesToTheOneThatHoldsItsJob) {
  std::list<std::string> ids;
  for (int n = 0; n < 2; ++n) {
    ids.push_back(submit("OFF " + std::to_string(n)));
    const FakeWorker worker(connect(), "at-first-" + std::to_string(n), 4, 8);
    watch(ids.back());
  }
  struct Waiting {
    std::string worker, job;
    bool derived = false;
    std::future<std::string> got;
  };
  std::vector<Waiting> workers;
  workers.push_back({"of-none", "", false, {}});
  workers.push_back({"of-first", ids.front(), false, {}});
  workers.push_back({"of-second", ids.back(), false, {}});
  workers.push_back({"derived-of-second", ids.back(), true, {}});
  for (Waiting& one : workers) {
    one.got = std::async(std::launch::async, [this, &one] {
      v1::LeaseTaskRequest request;
      request.set_wait_ms(30000);
      request.set_preferred_job(one.job);
      request.set_derived(one.derived);
      *request.mutable_worker() = worker_identity(one.worker);
      v1::LeaseTaskResponse response;
      grpc::ClientContext context;
      EXPECT_TRUE(worker_->LeaseTask(&context, request, &response).ok());
      return response.lease().job().id();
    });
    wait_for_workers(static_cast<int>(2 + (&one - workers.data()) + 1));
  }
  const std::uint64_t granted = job(ids.back()).counters().leases_granted();
  // The last that came, then one that came before it, then whoever is there.
  std::list<grpc::ClientContext> calls;
  std::list<std::future<Fetched>> fetched;
  double threshold = 10;
  for (const std::size_t expected : {3U, 2U, 0U, 1U}) {
    const v1::FetchArtifactRequest request = skeleton_request(ids.back(), ++threshold);
    grpc::ClientContext& call = calls.emplace_back();
    fetched.push_back(
        std::async(std::launch::async, [this, request, &call] { return fetch(*client_, request, &call); }));
    EXPECT_EQ(workers[expected].got.get(), ids.back()) << workers[expected].worker;
    // Nobody has it whose lease ended before.
    for (const Waiting& other : workers)
      EXPECT_TRUE(!other.got.valid() ||
                  other.got.wait_for(std::chrono::seconds(0)) == std::future_status::timeout)
          << other.worker << " instead of " << workers[expected].worker;
  }
  // Nor has any of them been taken from one and given to another, the last not either.
  EXPECT_EQ(job(ids.back()).counters().leases_granted(), granted + workers.size());
  for (grpc::ClientContext& call : calls) call.TryCancel();
}

TEST_F(WorkerServiceTest, WorkerThatWentAwayGetsNothing) {
  grpc::ClientContext context;
  std::thread waiting([&] {
    v1::LeaseTaskRequest request;
    *request.mutable_worker() = worker_identity("worker-gone");
    request.set_wait_ms(30000);
    v1::LeaseTaskResponse response;
    EXPECT_EQ(worker_->LeaseTask(&context, request, &response).error_code(), grpc::StatusCode::CANCELLED);
  });
  wait_for_workers(1);
  context.TryCancel();
  waiting.join();
  const std::string id = submit();
  // Should the cancelled call have been granted the task after all, it was given back at once.
  EXPECT_EQ(poll(30000).lease().job().id(), id);
}

TEST_F(WorkerServiceTest, StoppingServerEndsWaiting) {
  std::future<grpc::StatusCode> code = std::async(std::launch::async, [this] {
    grpc::ClientContext context;
    v1::LeaseTaskRequest request;
    *request.mutable_worker() = worker_identity();
    request.set_wait_ms(30000);
    v1::LeaseTaskResponse response;
    return worker_->LeaseTask(&context, request, &response).error_code();
  });
  wait_for_workers(1);
  server_->drain();
  EXPECT_EQ(code.get(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(WorkerServiceTest, WorkerWithoutAnIdentityIsRefusedAndForgotten) {
  for (const std::string& id : {std::string(), std::string(65, 'x')}) {
    grpc::ClientContext context;
    v1::LeaseTaskRequest request;
    *request.mutable_worker() = worker_identity(id);
    v1::LeaseTaskResponse response;
    EXPECT_EQ(worker_->LeaseTask(&context, request, &response).error_code(),
              grpc::StatusCode::INVALID_ARGUMENT);
  }
  EXPECT_TRUE(server_->registry().list().empty());
}

TEST_F(WorkerServiceTest, DrainingServerStillTakesReports) {
  const v1::Lease lease = block();
  server_->drain();
  v1::ReportResponse response;
  EXPECT_TRUE(send_report(*worker_, lease, 0, 4, false, &response).ok());
  EXPECT_EQ(server_->store().job(lease.job().id()).directions_done(), 4U);
}

TEST_F(WorkerServiceTest, ReportWithMissingRecordsIsRefused) {
  const v1::Lease lease = block();
  v1::ReportResponse response;
  EXPECT_EQ(send_report(*worker_, lease, 0, 1, false, &response, 11).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(job(lease.job().id()).directions_done(), 0U);
  EXPECT_TRUE(send_report(*worker_, lease, 0, 1, false, &response).ok());
}

// "Try again" would be no answer.
TEST_F(WorkerServiceTest, AResultThatIsTooLargeIsRefusedForGood) {
  submit();
  PrepareResult result = prepare_result(poll(0).lease().token(), 10, 40);
  result.header.set_bytes(std::uint64_t{1} << 31);
  EXPECT_EQ(send_result(*worker_, result.header, result.data).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(WorkerServiceTest, ReportInManyMessages) {
  const v1::Lease lease = block(20000, 16);
  v1::ReportResponse response;
  EXPECT_TRUE(send_report(*worker_, lease, 0, 16, true, &response).ok());
  v1::FetchArtifactRequest request = artifact_request(lease.job().id(), v1::ARTIFACT_KIND_FIELD);
  EXPECT_EQ(fetch(*client_, request).data, expected_field(20000, 16));
}

TEST_F(WorkerServiceTest, FencedWorkerIsTold) {
  const v1::Lease lease = block();
  grpc::ClientContext context;
  v1::ReturnLeaseRequest request;
  request.set_token(lease.token());
  v1::ReportResponse response;
  ASSERT_TRUE(worker_->ReturnLease(&context, request, &response).ok());
  EXPECT_EQ(send_report(*worker_, lease, 0, 1, false, &response).error_code(), grpc::StatusCode::ABORTED);
}

TEST_F(WorkerServiceTest, CancelledJobIsToldInTheNextReport) {
  const v1::Lease lease = block();
  grpc::ClientContext context;
  v1::CancelJobRequest request;
  request.set_job(lease.job().id());
  v1::Job marked;
  ASSERT_TRUE(client_->CancelJob(&context, request, &marked).ok());
  EXPECT_TRUE(marked.cancel_requested());
  v1::ReportResponse response;
  ASSERT_TRUE(send_report(*worker_, lease, 0, 1, false, &response).ok());
  EXPECT_TRUE(response.cancelled());
  EXPECT_EQ(job(lease.job().id()).state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(WorkerServiceTest, InputsOfATask) {
  const v1::Lease lease = block(10, 16);
  for (const v1::ArtifactKind kind : {v1::ARTIFACT_KIND_MESH, v1::ARTIFACT_KIND_LATTICE,
                                      v1::ARTIFACT_KIND_DIRECTIONS, v1::ARTIFACT_KIND_FIELD}) {
    grpc::ClientContext context;
    v1::FetchInputRequest request;
    request.set_token(lease.token());
    request.set_kind(kind);
    const auto reader = worker_->FetchInput(&context, request);
    v1::FetchArtifactResponse message;
    std::uint64_t bytes = 0;
    ASSERT_TRUE(reader->Read(&message));
    const v1::ArtifactHeader header = message.header();
    while (reader->Read(&message)) bytes += message.data().size();
    EXPECT_TRUE(reader->Finish().ok());
    EXPECT_EQ(bytes, header.bytes());
    EXPECT_GT(bytes, 0U);
  }
}

// Over a slow line its renewals wait behind the input that it takes.
TEST_F(WorkerServiceTest, TakingAnInputKeepsTheLease) {
  options_.store.report_interval_ms = 0;
  start();
  submit(std::string(std::size_t{1} << 20, 'x'));
  const v1::Lease lease = poll(0).lease();
  const auto deadline = [this] {
    Database db(options_.data_dir + "/affskel.db", Database::Mode::kReadOnly);
    return db.integer("SELECT deadline_ms FROM tasks WHERE state = 'leased'");
  };
  const auto before = deadline();
  for (int i = 0; i < 1000 && deadline() == before; ++i) {
    grpc::ClientContext context;
    v1::FetchInputRequest request;
    request.set_token(lease.token());
    request.set_kind(v1::ARTIFACT_KIND_MESH);
    const auto reader = worker_->FetchInput(&context, request);
    for (v1::FetchArtifactResponse message; reader->Read(&message);) continue;
    EXPECT_TRUE(reader->Finish().ok());
  }
  EXPECT_GT(deadline(), before);
}

TEST_F(WorkerServiceTest, SilentWorkerIsReplacedWithoutBeingAsked) {
  options_.store.lease_ms = 50;
  options_.store.report_interval_ms = 10;
  start();
  submit();
  const v1::Lease silent = poll(0, "worker-a").lease();
  const v1::LeaseTaskResponse replacement = poll(30000, "worker-b");
  ASSERT_TRUE(replacement.has_lease());
  EXPECT_NE(replacement.lease().token(), silent.token());
  EXPECT_EQ(replacement.lease().lease_ms(), 50U);
}

TEST_F(WorkerServiceTest, DeadProcessOfAPredecessorIsNoticed) {
  submit();
  const pid_t child = fork();
  if (child == 0) _exit(0);
  ASSERT_GT(child, 0);
  v1::WorkerIdentity worker = worker_identity();
  worker.set_host(wire::host_name());
  worker.set_pid(static_cast<std::uint32_t>(child));
  options_.store.lease_ms = 3'600'000;  // the test does not wait for this deadline
  start();
  ASSERT_TRUE(server_->store().lease(worker, "", true));
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_TRUE(poll(30000, "worker-b").has_lease());
}

}  // namespace
}  // namespace affskel::server
