#include <condition_variable>
#include <mutex>

#include "errors.h"
#include "rpc/event_hub.h"
#include "rpc/status.h"
#include "rpc/streams.h"
#include "rpc/upload_budget.h"
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

/// An upload of pieces of data.
struct FakeReader {
  std::vector<std::size_t> pieces;
  bool Read(v1::SubmitJobRequest* message) {
    if (pieces.empty()) return false;
    message->set_data(std::string(pieces.back(), 'm'));
    pieces.pop_back();
    return true;
  }
};

TEST(UploadBudgetTest, AllUploadsTogetherStayBelowIt) {
  UploadBudget budget(100);
  const auto upload = [](UploadBudget::Share& share, std::vector<std::size_t> pieces) {
    FakeReader reader{std::move(pieces)};
    return guarded([&] { receive_data<v1::SubmitJobRequest>(reader, 1000, share); }).error_code();
  };
  UploadBudget::Share first(budget);
  EXPECT_EQ(upload(first, {30, 30}), grpc::StatusCode::OK);
  {
    UploadBudget::Share second(budget);
    EXPECT_EQ(upload(second, {20, 39, 1}), grpc::StatusCode::UNAVAILABLE);
    EXPECT_EQ(upload(first, {1}), grpc::StatusCode::UNAVAILABLE) << "the second holds what it took so far";
  }
  UploadBudget::Share third(budget);
  EXPECT_EQ(upload(third, {40}), grpc::StatusCode::OK) << "an upload that ended gives back what it took";
  EXPECT_EQ(upload(third, {1}), grpc::StatusCode::UNAVAILABLE);
}

class EventHubTest : public testing::Test {
 protected:
  EventHubTest() {
    hub_.start(
        [](const std::string& id) {
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
