#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <mutex>

#include "database/errors.h"
#include "database/sqlite.h"
#include "rpc/event_hub.h"
#include "rpc/status.h"
#include "rpc/upload.h"
#include "rpc/worker_registry.h"
#include "store_fixture.h"
#include "wire/identity.h"

namespace affskel::server {
namespace {

template <typename Error>
grpc::StatusCode code_of(const Error& error) {
  return status_of(std::make_exception_ptr(error)).error_code();
}

TEST(StatusTest, EveryErrorHasItsCode) {
  using Code = StoreError::Code;
  EXPECT_EQ(code_of(StoreError(Code::kInvalid, "")), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code_of(StoreError(Code::kNotFound, "")), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(code_of(StoreError(Code::kExists, "")), grpc::StatusCode::ALREADY_EXISTS);
  EXPECT_EQ(code_of(StoreError(Code::kPrecondition, "")), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(code_of(StoreError(Code::kFenced, "")), grpc::StatusCode::ABORTED);
  EXPECT_EQ(code_of(StoreError(Code::kLimit, "")), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(code_of(SqliteError(SQLITE_FULL, "")), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(code_of(StoreError(Code::kDamaged, "")), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(code_of(StoreError(Code::kLost, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(SqliteError(SQLITE_IOERR_FSYNC, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(SqliteError(SQLITE_IOERR_WRITE, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(SqliteError(SQLITE_READONLY, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(SqliteError(SQLITE_IOERR_READ, "")), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(code_of(SqliteError(SQLITE_CORRUPT, "")), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(code_of(SqliteError(SQLITE_MISUSE, "")), grpc::StatusCode::INTERNAL);
  EXPECT_EQ(code_of(SqliteError(SQLITE_BUSY, "")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(std::bad_alloc()), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(code_of(std::runtime_error("")), grpc::StatusCode::INTERNAL);
  EXPECT_TRUE(guarded([] {}).ok());
}

TEST(StatusTest, StatementsAndPathsAreNotForClients) {
  for (const int code : {SQLITE_CORRUPT, SQLITE_BUSY, SQLITE_IOERR_READ, SQLITE_NOMEM, SQLITE_TOOBIG}) {
    const SqliteError error(code, "database /home/me/affskel.db: statement SELECT 1");
    const grpc::Status status = status_of(std::make_exception_ptr(error));
    EXPECT_EQ(status.error_message().find("SELECT"), std::string::npos) << status.error_message();
    EXPECT_EQ(status.error_message().find("/home"), std::string::npos) << status.error_message();
    EXPECT_FALSE(status.error_message().empty());
  }
}

TEST(StatusTest, LongMessagesAreCutAtACharacter) {
  const std::string quoted = "x" + [] {
    std::string text;
    for (int i = 0; i < 100000; ++i) text += "\xC3\xB6";
    return text;
  }();
  const std::string message =
      status_of(std::make_exception_ptr(StoreError(StoreError::Code::kInvalid, quoted))).error_message();
  EXPECT_LT(message.size(), 2000U);
  ASSERT_TRUE(message.ends_with("..."));
  EXPECT_EQ((message.size() - 4) % 2, 0U);  // x, whole characters of two bytes, the dots
  EXPECT_EQ(
      status_of(std::make_exception_ptr(StoreError(StoreError::Code::kInvalid, "short"))).error_message(),
      "short");
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

grpc::StatusCode add(Upload& upload, std::size_t bytes) {
  return guarded([&] { upload.add(std::string(bytes, 'm')); }).error_code();
}

TEST(UploadTest, AllTogetherStayBelowTheBudget) {
  UploadBudget budget(100);
  Upload first(budget, 1000);
  EXPECT_EQ(add(first, 30), grpc::StatusCode::OK);
  EXPECT_EQ(add(first, 30), grpc::StatusCode::OK);
  {
    Upload second(budget, 1000);
    EXPECT_EQ(add(second, 1), grpc::StatusCode::OK);
    EXPECT_EQ(add(second, 39), grpc::StatusCode::OK);
    EXPECT_EQ(add(second, 20), grpc::StatusCode::UNAVAILABLE);
    EXPECT_EQ(add(first, 1), grpc::StatusCode::UNAVAILABLE) << "the second holds what it took so far";
  }
  Upload third(budget, 1000);
  EXPECT_EQ(add(third, 40), grpc::StatusCode::OK) << "an upload that ended gives back what it took";
  EXPECT_EQ(add(third, 1), grpc::StatusCode::UNAVAILABLE);
}

TEST(UploadTest, LeavesAPartOfTheBudgetToOthers) {
  UploadBudget budget(100);
  Upload client(budget, 1000, 25), worker(budget, 1000);
  EXPECT_EQ(add(client, 75), grpc::StatusCode::OK);
  EXPECT_EQ(add(client, 1), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(add(worker, 25), grpc::StatusCode::OK);
}

TEST(UploadTest, HoldsWhatHasComeAndNotWhatIsAnnounced) {
  UploadBudget budget(std::uint64_t{1} << 40);
  Upload upload(budget, std::uint64_t{1} << 39);
  EXPECT_EQ(add(upload, 1000), grpc::StatusCode::OK);
  EXPECT_LE(upload.data().capacity(), 5000U);
  EXPECT_EQ(add(upload, 99000), grpc::StatusCode::OK);
  EXPECT_LE(upload.data().capacity(), 500000U);
}

TEST(UploadTest, MoreThanAnnouncedIsRefused) {
  UploadBudget budget(100);
  Upload upload(budget, 10);
  EXPECT_EQ(add(upload, 10), grpc::StatusCode::OK);
  EXPECT_EQ(add(upload, 1), grpc::StatusCode::INVALID_ARGUMENT);
}

class EventHubTest : public testing::Test {
 protected:
  EventHubTest() {
    hub_.start(
        [this](const std::string& id) {
          if (failures_ > 0) {
            --failures_;
            throw std::bad_alloc();
          }
          v1::Job job;
          job.set_id(id);
          return id == "deleted" ? nullptr : std::make_shared<const v1::Job>(job);
        },
        [this] { note("work"); });
  }
  ~EventHubTest() override { hub_.stop(); }

  EventHub::Subscription subscribe(const std::string& id, bool at_once = false) {
    return hub_.subscribe(
        id, [this](const EventHub::JobPtr& job) { note(job == nullptr ? "none" : job->id()); }, at_once);
  }

  void change(const std::string& id, bool work = false) {
    Changes changes;
    changes.jobs.insert(id);
    changes.work = work;
    hub_.on_change(changes);
  }

  void note(const std::string& what) {
    {
      const std::lock_guard lock(mutex_);
      heard_.push_back(what);
    }
    changed_.notify_all();
  }

  /// What was heard, as soon as it is this much.
  std::vector<std::string> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return heard_.size() >= count; });
    return heard_;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> heard_;
  std::atomic<int> failures_ = 0;
  EventHub hub_;
};

TEST_F(EventHubTest, TellsOnlyTheSubscribersOfAJob) {
  const EventHub::Subscription first = subscribe("first");
  change("second");
  change("first");
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"first"}));
}

TEST_F(EventHubTest, TellsTheStateAtOnceWhenAsked) {
  const EventHub::Subscription first = subscribe("first", true);
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"first"}));
}

TEST_F(EventHubTest, TellsOfDeletion) {
  const EventHub::Subscription gone = subscribe("deleted");
  change("deleted");
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"none"}));
}

TEST_F(EventHubTest, TellsOfWork) {
  change("first", true);
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"work"}));
}

// The last change of a job must not be the one that nobody hears of.
TEST_F(EventHubTest, WhatCouldNotBeReadIsToldLater) {
  const EventHub::Subscription first = subscribe("first"), second = subscribe("second");
  failures_ = 3;
  change("first");
  const std::vector<std::string> heard = wait_for(2);  // all is told again
  EXPECT_NE(std::find(heard.begin(), heard.end(), "first"), heard.end());
}

TEST_F(EventHubTest, EndedSubscriptionsHearNothing) {
  { const EventHub::Subscription ended = subscribe("first"); }
  const EventHub::Subscription moved = [&] { return subscribe("second"); }();
  change("first");
  change("second");
  EXPECT_EQ(wait_for(1), (std::vector<std::string>{"second"}));
}

TEST(WorkerRegistryTest, ShowsWhoWorksOnWhat) {
  const TestClock clock;
  WorkerRegistry registry(clock, 5000);
  registry.seen(worker_identity(), 2000);
  ASSERT_EQ(registry.list().size(), 1U);
  EXPECT_EQ(registry.list()[0].task(), "");
  v1::Lease lease;
  lease.set_token("token");
  lease.set_kind(v1::TASK_KIND_ERODE);
  lease.mutable_job()->set_id("job");
  registry.granted(worker_identity(), lease);
  EXPECT_EQ(registry.list()[0].task(), "erode job");
  registry.ended("token");
  EXPECT_EQ(registry.list()[0].task(), "");
}

TEST(WorkerRegistryTest, TellsTheSilentFromThoseWhoWait) {
  TestClock clock;
  WorkerRegistry registry(clock, 5000);
  registry.seen(worker_identity(), 30000);
  clock.advance(35000);
  EXPECT_FALSE(registry.list()[0].silent()) << "it may still wait for an answer, and that on its way";
  clock.advance(1);
  EXPECT_TRUE(registry.list()[0].silent());
  v1::Lease lease;
  lease.set_token("token");
  lease.set_kind(v1::TASK_KIND_ERODE);
  lease.mutable_job()->set_id("job");
  registry.granted(worker_identity(), lease);
  clock.advance(5000);
  EXPECT_EQ(registry.list()[0].task(), "erode job");
  clock.advance(1);
  EXPECT_TRUE(registry.list()[0].silent());
  EXPECT_EQ(registry.list()[0].task(), "") << "the lease has ended";
  registry.used("token");
  EXPECT_FALSE(registry.list()[0].silent());
  EXPECT_EQ(registry.list()[0].task(), "erode job");
}

TEST(WorkerRegistryTest, ForgetsTheSilentAfterAMinute) {
  TestClock clock;
  WorkerRegistry registry(clock, 5000);
  registry.seen(worker_identity(), 2000);
  v1::Lease lease;
  lease.set_token("token");
  lease.set_kind(v1::TASK_KIND_ERODE);
  registry.granted(worker_identity(), lease);
  clock.advance(59000);
  registry.used("token");
  clock.advance(59000);
  EXPECT_EQ(registry.list().size(), 1U);
  clock.advance(2000);
  EXPECT_TRUE(registry.list().empty());
}

TEST(WorkerRegistryTest, MadeUpWorkersFillNoMemory) {
  TestClock clock;
  WorkerRegistry registry(clock, 5000);
  v1::WorkerIdentity worker = worker_identity();
  registry.seen(worker, 2000);
  v1::Lease lease;
  lease.set_token("token");
  lease.set_kind(v1::TASK_KIND_ERODE);
  registry.granted(worker, lease);
  clock.advance(1);
  for (int i = 0; i < 5000; ++i) {
    v1::WorkerIdentity made_up = worker;
    made_up.set_id("made up " + std::to_string(i));
    registry.seen(made_up, 0);
  }
  const std::vector<v1::WorkerInfo> list = registry.list();
  EXPECT_EQ(list.size(), 4096U);
  const auto honest = [&](const v1::WorkerInfo& info) { return info.id() == worker.id(); };
  EXPECT_TRUE(std::any_of(list.begin(), list.end(), honest)) << "who works is not forgotten for them";
}

TEST(WorkerRegistryTest, KnowsTheSupervised) {
  const TestClock clock;
  WorkerRegistry registry(clock, 5000);
  v1::WorkerIdentity worker = worker_identity();
  worker.set_host(wire::host_name());
  EXPECT_FALSE(registry.is_supervised(worker));
  registry.add_supervised(worker.pid());
  EXPECT_TRUE(registry.is_supervised(worker));
  worker.set_host("another-host");
  EXPECT_FALSE(registry.is_supervised(worker));
  worker.set_host(wire::host_name());
  registry.seen(worker, 2000);
  registry.remove_supervised(worker.pid());
  EXPECT_TRUE(registry.list().empty());
}

}  // namespace
}  // namespace affskel::server
