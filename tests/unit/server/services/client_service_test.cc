#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sqlite3.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <list>
#include <sstream>

#include "service_fixture.h"

namespace affskel::server {
namespace {

using ClientServiceTest = ServiceTest;

std::atomic<bool> disk_is_full = false;

ssize_t pwrite_or_full(int fd, const void* bytes, size_t count, off_t offset) {
  if (!disk_is_full) return pwrite(fd, bytes, count, offset);
  errno = ENOSPC;
  return -1;
}

/// Lets every write of SQLite fail as on a full disk.
class FullDisk {
 public:
  FullDisk() : vfs_(sqlite3_vfs_find(nullptr)) {
    for (const char* name : {"pwrite", "pwrite64"}) {
      vfs_->xSetSystemCall(vfs_, name, reinterpret_cast<sqlite3_syscall_ptr>(pwrite_or_full));
    }
    disk_is_full = true;
  }
  ~FullDisk() {
    disk_is_full = false;
    vfs_->xSetSystemCall(vfs_, nullptr, nullptr);
  }

 private:
  sqlite3_vfs* vfs_;
};

std::uint64_t free_or_none(const std::string& directory) {
  return disk_is_full ? 0 : free_bytes(directory);
}

TEST_F(ClientServiceTest, AFullDiskIsTheReasonWhyAJobGetsNoFurther) {
  options_.store.free_bytes = free_or_none;
  start();
  const std::string id = submit();
  const PrepareResult result = prepare_result(poll(0).lease().token(), 10, 40);
  ASSERT_TRUE(send_result(*worker_, result.header, result.data).ok());
  const v1::Lease block = poll(0).lease();
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_job(id);
  const auto reader = client_->WatchJob(&context, request);
  v1::Job seen;
  ASSERT_TRUE(reader->Read(&seen));
  v1::ReportResponse response;
  {
    const FullDisk full;
    EXPECT_EQ(send_report(*worker_, block, 0, 4, false, &response).error_code(),
              grpc::StatusCode::RESOURCE_EXHAUSTED);
    while (seen.waiting_reason().find("disk is full") == std::string::npos) ASSERT_TRUE(reader->Read(&seen));
    server_->store().expire_leases();  // writes nothing, so it must not look like room
    EXPECT_NE(job(id).waiting_reason(), "");
  }
  EXPECT_TRUE(send_report(*worker_, block, 0, 4, false, &response).ok());
  EXPECT_EQ(job(id).waiting_reason(), "");
  EXPECT_EQ(job(id).directions_done(), 4U);
  context.TryCancel();
  reader->Finish();
}

TEST_F(ClientServiceTest, AFullDiskIsLoggedOnceAndNotForEveryCallThatMeetsIt) {
  options_.store.free_bytes = free_or_none;
  start();
  std::ostringstream lines;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(lines)));
  {
    const FullDisk full;
    v1::SubmitJobResponse response;
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(submit_mesh(*client_, submit_header("OFF 1"), "OFF 1", &response).error_code(),
                grpc::StatusCode::RESOURCE_EXHAUSTED);
    }
  }
  spdlog::set_default_logger(before);
  const std::string log = lines.str();
  const std::size_t first = log.find("event=disk_full");
  EXPECT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find("full", first + 15), std::string::npos) << log;
}

TEST_F(ClientServiceTest, AJobThatAnIdleWorkerIsAboutToTakeDoesNotWaitForBusyOnes) {
  EXPECT_FALSE(poll(0, "worker-a").has_lease());
  const std::string id = submit();
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(job(id).waiting_reason(), "");
  ASSERT_TRUE(poll(0, "worker-a").has_lease());
  const std::string other = submit("OFF 2", "other");
  EXPECT_EQ(job(other).waiting_reason(), "the only worker is busy with jobs of the same owner");
}

TEST_F(ClientServiceTest, WholePathWithTwoWorkers) {
  const FakeWorker first(connect(), "worker-a", 5000, 100);
  const FakeWorker second(connect(), "worker-b", 5000, 100);
  const std::string id = submit();
  const v1::Job done = watch(id);
  EXPECT_EQ(done.state(), v1::JOB_STATE_DONE);
  EXPECT_EQ(done.directions_done(), 100U);
  const Fetched field = fetch(*client_, artifact_request(id, v1::ARTIFACT_KIND_FIELD));
  ASSERT_TRUE(field.status.ok()) << field.status.error_message();
  EXPECT_EQ(field.data, expected_field(5000, 100));
  EXPECT_EQ(field.header.bytes(), field.data.size());
  EXPECT_EQ(field.header.job().id(), id);
}

TEST_F(ClientServiceTest, WatchSaysFirstWhatIs) {
  const std::string id = submit();
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_job(id.substr(0, 8));
  const auto reader = client_->WatchJob(&context, request);
  v1::Job job;
  ASSERT_TRUE(reader->Read(&job));
  EXPECT_EQ(job.state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(job.waiting_reason(), "no worker is connected");
  ASSERT_TRUE(poll(0).has_lease());
  // A change may be told twice, never a newer state before an older one.
  while (job.state() == v1::JOB_STATE_QUEUED) ASSERT_TRUE(reader->Read(&job));
  EXPECT_EQ(job.state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(job.waiting_reason(), "");
  context.TryCancel();
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
}

TEST_F(ClientServiceTest, WatchOfAFinishedJobEndsAtOnce) {
  const std::string id = submit();
  server_->store().cancel(id);
  EXPECT_EQ(watch(id).state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(ClientServiceTest, WatchOfNoJobIsRefused) {
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_job("0123456789ab");
  v1::Job job;
  const auto reader = client_->WatchJob(&context, request);
  EXPECT_FALSE(reader->Read(&job));
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(ClientServiceTest, ManyWatchersDoNotStarveOthers) {
  const std::string id = submit();
  struct Watch {
    grpc::ClientContext context;
    std::unique_ptr<grpc::ClientReader<v1::Job>> reader;
  };
  std::list<Watch> watches;
  v1::WatchJobRequest request;
  request.set_job(id);
  for (int i = 0; i < 300; ++i) {
    Watch& watch = watches.emplace_back();
    watch.reader = client_->WatchJob(&watch.context, request);
    v1::Job job;
    ASSERT_TRUE(watch.reader->Read(&job));
  }
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_QUEUED);
  server_->store().cancel(id);
  for (Watch& watch : watches) {
    v1::Job last;
    for (v1::Job next; watch.reader->Read(&next);) last = next;
    EXPECT_EQ(last.state(), v1::JOB_STATE_CANCELLED);
    EXPECT_TRUE(watch.reader->Finish().ok());
  }
}

TEST_F(ClientServiceTest, StoppingServerEndsWatches) {
  const std::string id = submit();
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  request.set_job(id);
  const auto reader = client_->WatchJob(&context, request);
  v1::Job job;
  ASSERT_TRUE(reader->Read(&job));
  server_->stop();
  while (reader->Read(&job)) {
  }
  // CANCELLED when a message was on its way: both mean "again".
  const grpc::StatusCode code = reader->Finish().error_code();
  EXPECT_TRUE(code == grpc::StatusCode::UNAVAILABLE || code == grpc::StatusCode::CANCELLED) << code;
}

TEST_F(ClientServiceTest, JobsSurviveARestart) {
  const std::string id = submit();
  start();
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_QUEUED);
  const FakeWorker worker(connect(), "worker-a", 10, 20);
  EXPECT_EQ(watch(id).state(), v1::JOB_STATE_DONE);
}

TEST_F(ClientServiceTest, SubmissionsAreChecked) {
  v1::SubmitJobResponse response;
  v1::SubmitJobHeader header = submit_header("OFF 1");
  EXPECT_EQ(submit_mesh(*client_, header, "OFF 2", &response).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(submit_mesh(*client_, header, "OFF", &response).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(submit_mesh(*client_, header, "OFF 1 and more", &response).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
  header.set_mesh_bytes((std::uint64_t{1} << 30) + 1);
  EXPECT_EQ(submit_mesh(*client_, header, "", &response).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(server_->store().counts().total, 0);
}

TEST_F(ClientServiceTest, AWrongHeaderIsRefusedBeforeItsMesh) {
  v1::SubmitJobHeader header = submit_header("OFF 1");
  header.set_priority(10);
  grpc::ClientContext context;
  v1::SubmitJobResponse response;
  const auto writer = client_->SubmitJob(&context, &response);
  v1::SubmitJobRequest message;
  *message.mutable_header() = header;
  writer->Write(message);
  // Neither data nor an end of them.
  EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(ClientServiceTest, SubmissionMustBeginWithItsHeader) {
  grpc::ClientContext context;
  v1::SubmitJobResponse response;
  const auto writer = client_->SubmitJob(&context, &response);
  v1::SubmitJobRequest message;
  message.set_data("OFF");
  writer->Write(message);
  writer->WritesDone();
  EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(ClientServiceTest, LargeMeshComesBackUnchanged) {
  std::string mesh;
  for (int i = 0; mesh.size() < (std::size_t{5} << 20); ++i) mesh += std::to_string(i) + "\r\n";
  const std::string id = submit(mesh);
  const Fetched fetched = fetch(*client_, artifact_request(id, v1::ARTIFACT_KIND_MESH));
  EXPECT_TRUE(fetched.status.ok());
  EXPECT_EQ(fetched.data, mesh);
}

TEST_F(ClientServiceTest, FetchWaitsForADerivedArtefact) {
  const FakeWorker worker(connect(), "worker-a", 10, 20);
  const std::string id = submit();
  watch(id);
  const Fetched fetched = fetch(*client_, skeleton_request(id, 3));
  EXPECT_TRUE(fetched.status.ok()) << fetched.status.error_message();
  EXPECT_EQ(fetched.data, "skeleton");
}

TEST_F(ClientServiceTest, FetchReportsWhyAnArtefactFailed) {
  std::string id;
  {
    const FakeWorker worker(connect(), "worker-a", 10, 20);
    id = submit();
    watch(id);
  }
  Fetched fetched;
  std::thread waiting([&] { fetched = fetch(*client_, skeleton_request(id, 3)); });
  const v1::LeaseTaskResponse task = poll(30000);
  EXPECT_TRUE(task.has_lease());
  v1::FailTaskRequest failure;
  failure.set_token(task.lease().token());
  failure.mutable_error()->set_code("LIMIT");
  failure.mutable_error()->set_message("too many points");
  grpc::ClientContext context;
  v1::ReportResponse response;
  EXPECT_TRUE(worker_->FailTask(&context, failure, &response).ok());
  waiting.join();
  EXPECT_EQ(fetched.status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(fetched.status.error_message(), "too many points");
}

TEST_F(ClientServiceTest, ARequestLeavesWithTheClientThatAsked) {
  std::string id;
  {
    const FakeWorker worker(connect(), "worker-a", 10, 20);
    id = submit();
    watch(id);
  }
  grpc::ClientContext context;
  Fetched fetched;
  std::thread waiting([&] { fetched = fetch(*client_, skeleton_request(id, 3), &context); });
  while (server_->store().counts().requests == 0) std::this_thread::yield();
  context.TryCancel();
  waiting.join();
  EXPECT_EQ(fetched.status.error_code(), grpc::StatusCode::CANCELLED);
  while (server_->store().counts().requests > 0) std::this_thread::yield();
}

TEST_F(ClientServiceTest, FetchBeforeTheEndIsRefused) {
  const std::string id = submit();
  EXPECT_EQ(fetch(*client_, artifact_request(id, v1::ARTIFACT_KIND_FIELD)).status.error_code(),
            grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(fetch(*client_, artifact_request("0123456789", v1::ARTIFACT_KIND_FIELD)).status.error_code(),
            grpc::StatusCode::NOT_FOUND);
}

TEST_F(ClientServiceTest, TellsAboutItself) {
  const std::string id = submit();
  const v1::LeaseTaskResponse task = poll(0);
  grpc::ClientContext context;
  v1::ServerInfo info;
  ASSERT_TRUE(client_->GetServerInfo(&context, {}, &info).ok());
  EXPECT_EQ(info.pid(), static_cast<std::uint32_t>(getpid()));
  EXPECT_EQ(info.data_dir(), options_.data_dir);
  EXPECT_EQ(info.jobs_running(), 1U);
  EXPECT_EQ(info.jobs_total(), 1U);
  ASSERT_EQ(info.workers_size(), 1);
  EXPECT_EQ(info.workers(0).id(), "worker-a");
  EXPECT_EQ(info.workers(0).task(), "prepare " + id);
}

TEST_F(ClientServiceTest, IsIdleOnlyWithoutWorkAndClients) {
  const std::string id = submit();
  EXPECT_EQ(server_->idle_time(), std::chrono::steady_clock::duration::zero()) << "there is work";
  server_->store().cancel(id);
  grpc::ClientContext context;
  v1::WatchJobRequest request;
  const std::string other = submit("OFF 2");
  request.set_job(other);
  const auto reader = client_->WatchJob(&context, request);
  v1::Job job;
  ASSERT_TRUE(reader->Read(&job));
  EXPECT_EQ(server_->idle_time(), std::chrono::steady_clock::duration::zero()) << "somebody watches";
  server_->store().cancel(other);
  while (reader->Read(&job)) {
  }
  EXPECT_TRUE(reader->Finish().ok());
  while (server_->idle_time() == std::chrono::steady_clock::duration::zero()) std::this_thread::yield();
}

// No client calls: they would count by themselves.
TEST_F(ClientServiceTest, IsNotIdleWhileDeletedJobsAreTidiedAway) {
  constexpr auto kZero = std::chrono::steady_clock::duration::zero();
  const std::string mesh = "OFF 1";
  const std::string id = server_->store().submit(submit_header(mesh, "body"), mesh).job.id();
  Database db(server_->store().file(), Database::Mode::kReadWrite);
  // Tidying has no end as long as what it deletes comes back.
  db.execute(
      "CREATE TABLE steps (id INTEGER PRIMARY KEY);"
      "CREATE TRIGGER comes_back AFTER DELETE ON mesh_chunks BEGIN"
      " INSERT INTO steps VALUES (NULL);"
      " INSERT INTO mesh_chunks (sha256, idx, data) VALUES (OLD.sha256, OLD.idx, OLD.data);"
      " END");
  server_->store().cancel(id);
  server_->store().remove(id);
  // With the second step begun, the server knows that the first was not the last.
  while (db.integer("SELECT count(*) FROM steps") < 2) std::this_thread::yield();
  const auto still_tidying = std::chrono::steady_clock::now();
  EXPECT_EQ(server_->idle_time(), kZero);

  db.execute("DROP TRIGGER comes_back");
  auto idle = kZero;
  while (idle == kZero) idle = server_->idle_time();
  EXPECT_EQ(db.integer("SELECT count(*) FROM mesh_chunks"), 0) << "idle with a deleted mesh on the disk";
  EXPECT_LE(idle, std::chrono::steady_clock::now() - still_tidying)
      << "counted from before the end of tidying";
}

TEST_F(ClientServiceTest, MoreWatchesThanThereMayBeAreRefused) {
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

TEST_F(ClientServiceTest, ADrainingServerTakesNoNewStreamsOfClients) {
  const std::string id = submit();
  server_->drain();
  v1::SubmitJobResponse response;
  EXPECT_EQ(submit_mesh(*client_, submit_header("OFF 2"), "OFF 2", &response).error_code(),
            grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(fetch(*client_, mesh_request(id)).status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_QUEUED) << "short calls are answered to the end";
}

TEST_F(ClientServiceTest, CompressedMessagesAreNotUnpacked) {
  v1::GetJobRequest request;
  request.set_job(std::string(std::size_t{16} << 20, 'x'));  // too long only when it is unpacked
  grpc::ClientContext context;
  context.set_compression_algorithm(GRPC_COMPRESS_GZIP);
  v1::Job job;
  EXPECT_EQ(client_->GetJob(&context, request, &job).error_code(), grpc::StatusCode::UNIMPLEMENTED);
}

}  // namespace
}  // namespace affskel::server
