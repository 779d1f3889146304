#include "scheduling/worker_registry.h"

#include <algorithm>
#include <string>
#include <vector>

#include "store_fixture.h"
#include "wire/identity.h"

namespace affskel::server {
namespace {

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
