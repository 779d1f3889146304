// What a server tells of itself, against what was done to it.
#include "service_fixture.h"
#include "tools/exposition.h"
#include "tools/http_get.h"

namespace affskel::server {
namespace {

class ServerMetricsTest : public ServiceTest {
 protected:
  ServerMetricsTest() {
    options_.metrics = wire::parse_address("127.0.0.1:0");
    start();
  }

  std::map<std::string, tests::Exposed> scrape() {
    return tests::read_exposition(tests::http_get(server_->metrics_address()->target(), "/metrics").body);
  }

  /// Once the value is that: what a client was answered may be counted a moment later.
  void wait_for(const std::string& name, const std::map<std::string, std::string>& labels, double value) {
    for (;;) {
      try {
        if (value_of(scrape(), name, labels) == value) return;
      } catch (const std::out_of_range&) {
        // Nothing of the kind was counted yet.
      }
      std::this_thread::yield();
    }
  }
};

TEST_F(ServerMetricsTest, EveryMetricIsOursAndHasHelp) {
  const FakeWorker worker(connect(), "worker-a", 10, 16);
  watch(submit());
  for (const auto& [name, metric] : scrape()) {
    EXPECT_TRUE(name.starts_with("affskel_")) << name;
    EXPECT_GT(metric.help.size(), 10U) << name;
  }
}

TEST_F(ServerMetricsTest, CountTheWorkThatWasDone) {
  std::string first;
  {
    const FakeWorker worker(connect(), "worker-a", 50, 100);
    first = submit();
    ASSERT_EQ(watch(first).state(), v1::JOB_STATE_DONE);
  }
  const v1::Job done = job(first);
  const auto seen = scrape();
  EXPECT_EQ(value_of(seen, "affskel_directions_total"), 100);
  EXPECT_EQ(value_of(seen, "affskel_owner_directions_total", {{"owner", done.owner()}}), 100);
  double granted = 0, finished = 0;
  for (const auto& sample : seen.at("affskel_leases_granted_total").samples) granted += sample.value;
  for (const auto& sample : seen.at("affskel_task_duration_seconds").samples) {
    if (sample.name.ends_with("_count")) finished += sample.value;
  }
  EXPECT_EQ(granted, static_cast<double>(done.counters().leases_granted()));
  EXPECT_EQ(finished, granted) << "none was lost";
  EXPECT_EQ(value_of(seen, "affskel_jobs_submitted_total"), 1);
  EXPECT_EQ(value_of(seen, "affskel_jobs_ended_total", {{"state", "done"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_jobs", {{"state", "done"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_jobs", {{"state", "queued"}}), 0);
  for (const char* stage : {"prepare", "erode", "derive"}) {
    EXPECT_EQ(value_of(seen, "affskel_stage_duration_seconds_count", {{"stage", stage}}), 1) << stage;
  }
  EXPECT_EQ(value_of(seen, "affskel_owner_mesh_bytes", {{"owner", done.owner()}}), 5) << "OFF 1";
  EXPECT_GT(value_of(seen, "affskel_owner_result_bytes", {{"owner", done.owner()}}), 50 * 20);
  EXPECT_GT(value_of(seen, "affskel_database_bytes"), 50 * 20);
  EXPECT_GT(value_of(seen, "affskel_transaction_duration_seconds_count"), granted);
  wait_for("affskel_calls_total", {{"method", "ReportErosion"}, {"code", "OK"}},
           static_cast<double>(done.counters().reports()));
}

TEST_F(ServerMetricsTest, TellTheQueueByPriority) {
  for (const auto& [mesh, priority] : {std::pair("OFF a", 2), std::pair("OFF b", 7), std::pair("OFF c", 7)}) {
    v1::SubmitJobHeader header = submit_header(mesh);
    header.set_priority(static_cast<std::uint32_t>(priority));
    v1::SubmitJobResponse response;
    ASSERT_TRUE(submit_mesh(*client_, header, mesh, &response).ok());
  }
  auto seen = scrape();
  EXPECT_EQ(value_of(seen, "affskel_queue_jobs", {{"priority", "7"}}), 2);
  EXPECT_EQ(value_of(seen, "affskel_queue_tasks", {{"priority", "2"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_queue_jobs", {{"priority", "5"}}), 0);
  EXPECT_EQ(value_of(seen, "affskel_leases", {{"kind", "prepare"}}), 0) << "none is a number, too";
  ASSERT_TRUE(poll(0).has_lease());
  seen = scrape();
  EXPECT_EQ(value_of(seen, "affskel_queue_jobs", {{"priority", "7"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_leases", {{"kind", "prepare"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_workers", {{"state", "busy"}}), 1);
  EXPECT_EQ(value_of(seen, "affskel_workers", {{"state", "idle"}}), 0);
  EXPECT_EQ(value_of(seen, "affskel_worker_threads"), 1);
}

TEST_F(ServerMetricsTest, TellTasksThatNoWorkerHasTheMemoryFor) {
  v1::SubmitJobHeader header = submit_header("OFF a");
  header.mutable_params()->mutable_sampling()->set_target_points(std::uint64_t{1} << 31);
  v1::SubmitJobResponse response;
  ASSERT_TRUE(submit_mesh(*client_, header, "OFF a", &response).ok());
  EXPECT_EQ(value_of(scrape(), "affskel_queue_too_large_tasks"), 0) << "nobody is there";
  const auto come = [&](const std::string& worker, std::uint64_t memory) {
    v1::LeaseTaskRequest request;
    *request.mutable_worker() = worker_identity(worker);
    request.mutable_worker()->set_memory(memory);
    grpc::ClientContext context;
    v1::LeaseTaskResponse answer;
    EXPECT_TRUE(worker_->LeaseTask(&context, request, &answer).ok());
    return answer.has_lease();
  };
  EXPECT_FALSE(come("worker-a", std::uint64_t{1} << 30));
  EXPECT_EQ(value_of(scrape(), "affskel_queue_too_large_tasks"), 1);
  header = submit_header("OFF b");
  ASSERT_TRUE(submit_mesh(*client_, header, "OFF b", &response).ok());
  EXPECT_EQ(value_of(scrape(), "affskel_queue_too_large_tasks"), 1) << "that one is small";
  EXPECT_TRUE(come("worker-b", std::uint64_t{1} << 40));
  EXPECT_EQ(value_of(scrape(), "affskel_queue_too_large_tasks"), 0);
}

TEST_F(ServerMetricsTest, CountRefusalsAndFencedLeases) {
  grpc::ClientContext context;
  v1::GetJobRequest request;
  request.set_job("000000");
  v1::Job none;
  EXPECT_EQ(client_->GetJob(&context, request, &none).error_code(), grpc::StatusCode::NOT_FOUND);
  grpc::ClientContext fenced;
  v1::RenewLeaseRequest renew;
  renew.set_token("ended");
  v1::ReportResponse response;
  EXPECT_EQ(worker_->RenewLease(&fenced, renew, &response).error_code(), grpc::StatusCode::ABORTED);
  wait_for("affskel_calls_total", {{"method", "GetJob"}, {"code", "NOT_FOUND"}}, 1);
  wait_for("affskel_calls_total", {{"method", "RenewLease"}, {"code", "ABORTED"}}, 1);
  wait_for("affskel_leases_fenced_total", {}, 1);
}

TEST_F(ServerMetricsTest, HealthEndsWithTheDrain) {
  const std::string address = server_->metrics_address()->target();
  EXPECT_EQ(tests::http_get(address, "/healthz").code, 200);
  server_->drain();
  EXPECT_EQ(tests::http_get(address, "/healthz").code, 503);
}

TEST_F(ServerMetricsTest, AreToldToNobodyUnlessAsked) {
  options_.metrics.reset();
  start();
  EXPECT_EQ(server_->metrics_address(), std::nullopt);
  options_.metrics = wire::parse_address("0.0.0.0:0");
  server_.reset();
  EXPECT_THROW(Server{options_}, std::runtime_error);
}

}  // namespace
}  // namespace affskel::server
