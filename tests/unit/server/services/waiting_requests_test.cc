// Requests that wait for an artefact to be computed.
#include <chrono>

#include "service_fixture.h"

namespace affskel::server {
namespace {

/// A finished job, and no worker to derive anything from it.
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

  // Whether something comes true within a minute.
  template <class Condition>
  static bool comes_true(const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
      if (std::chrono::steady_clock::now() >= end) return false;
      std::this_thread::yield();
    }
    return true;
  }
  void wait_for_waiting(std::size_t count) {
    ASSERT_TRUE(comes_true([&] { return server_->room().waiting.used() == count; })) << count;
  }
  void wait_for_requests(std::int64_t count) {
    ASSERT_TRUE(comes_true([&] { return requests() == count; })) << count;
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
  wait_for_requests(2);
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
  wait_for_requests(0);
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
    wait_for_requests(1);
  }
  // A worker that took the request of a caller that is just going would lose it.
  wait_for_waiting(0);
  wait_for_requests(0);
  const Waiting last(connect(), id, 3);
  wait_for_waiting(1);
  const FakeWorker worker(connect(), "worker-a", 10, 20);
  wait_for_waiting(0);
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

}  // namespace
}  // namespace affskel::server
