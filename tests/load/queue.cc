#include <algorithm>
#include <cstdio>

#include "../integration/lab.h"
#include "calls.h"
#include "loads.h"
#include "process_stats.h"

namespace affskel::load {
namespace {

constexpr int kMeasured = 500;

grpc::Status lease(v1::WorkerService::Stub& stub, int number, bool* granted) {
  v1::LeaseTaskRequest request;
  v1::WorkerIdentity& worker = *request.mutable_worker();
  worker.set_id("queue-" + std::to_string(number));
  worker.set_host("load");
  worker.set_pid(1);
  worker.set_threads(1);
  worker.set_core_version("made-up");
  request.set_wait_ms(1000);
  grpc::ClientContext context;
  v1::LeaseTaskResponse response;
  const grpc::Status status = stub.LeaseTask(&context, request, &response);
  *granted = response.has_lease();
  return status;
}

}  // namespace

bool run_queue(const LoadOptions& options) {
  const integration::Lab lab;
  const integration::Process server = lab.server({"--lease-ms", "600000"});
  const auto channel = connect(lab.address());
  const auto clients = v1::ErosionService::NewStub(channel);
  const auto workers = v1::WorkerService::NewStub(channel);
  Calls calls;
  for (int i = 0; i < options.jobs; ++i) {
    const std::string mesh = "mesh " + std::to_string(i);
    v1::Job job;
    calls.timed("submit", [&] { return submit(*clients, mesh, mesh, &job); });
  }
  const int measured = std::min(kMeasured, options.jobs);
  int granted = 0;
  for (int i = 0; i < measured; ++i) {
    bool one = false;
    calls.timed("lease", [&] { return lease(*workers, i, &one); });
    granted += one ? 1 : 0;
    calls.timed("list", [&] {
      grpc::ClientContext context;
      v1::ListJobsResponse response;
      return clients->ListJobs(&context, {}, &response);
    });
    calls.timed("list queued", [&] {
      grpc::ClientContext context;
      v1::ListJobsRequest request;
      request.add_states(v1::JOB_STATE_RUNNING);
      v1::ListJobsResponse response;
      return clients->ListJobs(&context, request, &response);
    });
  }
  std::printf("queue: %d jobs wait, %d of %d leases granted\n", options.jobs, granted, measured);
  calls.print();
  std::printf("\n");
  return calls.failures() == 0 && granted == measured;
}

}  // namespace affskel::load
