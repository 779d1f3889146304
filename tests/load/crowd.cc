#include <algorithm>
#include <atomic>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <thread>

#include "../integration/lab.h"
#include "loads.h"
#include "made_up_worker.h"
#include "open_watches.h"
#include "process_stats.h"
#include "tools/exposition.h"
#include "tools/http_get.h"
#include "tools/let_pass.h"

namespace affskel::load {
namespace {

constexpr int kSenders = 8;
constexpr int kFirstSeconds = 10;

grpc::Status get(v1::ErosionService::Stub& stub, const std::string& id) {
  grpc::ClientContext context;
  v1::GetJobRequest request;
  request.set_job(id);
  v1::Job job;
  return stub.GetJob(&context, request, &job);
}

grpc::Status list(v1::ErosionService::Stub& stub) {
  grpc::ClientContext context;
  v1::ListJobsResponse response;
  return stub.ListJobs(&context, {}, &response);
}

/// Follows for a while, as a person does who looks at a terminal; deadlines are no failures.
grpc::Status watch(v1::ErosionService::Stub& stub, const std::string& id, std::chrono::milliseconds time) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + time);
  v1::WatchJobRequest request;
  request.set_job(id);
  const auto reader = stub.WatchJob(&context, request);
  v1::Job job;
  while (reader->Read(&job)) {
  }
  const grpc::Status status = reader->Finish();
  return status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED ? grpc::Status::OK : status;
}

void run_client(const std::string& address, int number, const std::stop_token& stop, Calls& calls) {
  const auto stub = v1::ErosionService::NewStub(connect(address));
  for (int round = 0; !stop.stop_requested(); ++round) {
    const std::string mesh = "mesh " + std::to_string(number) + "." + std::to_string(round);
    v1::Job job;
    if (!calls.timed("submit", [&] { return submit(*stub, mesh, mesh, &job); })) continue;
    std::thread follower(
        [&] { calls.timed("watch", [&] { return watch(*stub, job.id(), std::chrono::seconds(2)); }); });
    for (int i = 0; i < 4; ++i) {
      calls.timed("get", [&] { return get(*stub, job.id()); });
      calls.timed("list", [&] { return list(*stub); });
      tests::let_pass(std::chrono::milliseconds(500), stop);
    }
    follower.join();
  }
}

/// Jobs that no worker has begun, sent by several at once.
std::vector<std::string> queue_jobs(const std::string& address, int number, Calls& calls) {
  std::vector<std::string> ids(static_cast<std::size_t>(number));
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> senders;
  for (int i = 0; i < kSenders; ++i) {
    senders.emplace_back([&] {
      const auto stub = v1::ErosionService::NewStub(connect(address));
      for (std::size_t n = next++; n < ids.size(); n = next++) {
        const std::string mesh = "queued mesh " + std::to_string(n);
        v1::Job job;
        calls.timed("queue", [&] { return submit(*stub, mesh, mesh, &job); });
        ids[n] = job.id();
      }
    });
  }
  senders.clear();
  return ids;
}

/// As often as a collector asks at most; what it gets must be well-formed.
void run_scraper(const std::string& address, const std::stop_token& stop, Calls& calls) {
  while (!stop.stop_requested()) {
    calls.timed("scrape", [&]() -> grpc::Status {
      try {
        const tests::HttpAnswer answer = tests::http_get(address, "/metrics");
        if (answer.code != 200) return {grpc::StatusCode::UNAVAILABLE, answer.body};
        tests::read_exposition(answer.body);
        return grpc::Status::OK;
      } catch (const std::runtime_error& error) {
        return {grpc::StatusCode::INTERNAL, error.what()};
      }
    });
    tests::let_pass(std::chrono::seconds(1), stop);
  }
}

}  // namespace

bool run_crowd(const LoadOptions& options) {
  const integration::Lab lab;
  const integration::Process server = lab.server(
      options.metrics ? std::vector<std::string>{"--metrics", "127.0.0.1:0"} : std::vector<std::string>());
  Calls calls;
  const std::vector<std::string> ids = queue_jobs(lab.address(), options.queued, calls);
  std::optional<OpenWatches> watches;
  if (options.queued > 0) watches.emplace(lab.address(), ids, options.watches, calls);
  std::stop_source stop;
  std::vector<std::thread> threads;
  std::vector<MadeUpWorkerOptions> workers(static_cast<std::size_t>(options.workers));
  for (std::size_t i = 0; i < workers.size(); ++i) {
    workers[i].address = lab.address();
    workers[i].id = "made-up-" + std::to_string(i);
    workers[i].work_waits = options.queued > 0;
    threads.emplace_back([&, i] { run_made_up_worker(workers[i], stop.get_token(), calls); });
  }
  for (int i = 0; i < options.clients; ++i) {
    threads.emplace_back([&, i] { run_client(lab.address(), i, stop.get_token(), calls); });
  }
  if (options.metrics) {
    threads.emplace_back([&] { run_scraper(lab.metrics_address(), stop.get_token(), calls); });
  }
  const int first = std::min(options.seconds, kFirstSeconds);
  tests::let_pass(std::chrono::seconds(first));
  if (options.seconds > first) {
    std::printf("crowd: the first %d s, in which all come at once\n", first);
    calls.print();
    calls.forget_times();
  }
  tests::let_pass(std::chrono::seconds(options.seconds - first));
  const ProcessStats stats = stats_of(server.pid());
  stop.request_stop();
  for (std::thread& thread : threads) thread.join();
  watches.reset();
  std::printf("crowd: %d clients, %d workers, %d jobs queued before, %d watches, %d s\n", options.clients,
              options.workers, options.queued, options.queued > 0 ? options.watches : 0, options.seconds);
  calls.print();
  std::printf("server: peak %.0f MiB, %ld threads, %ld descriptors\n\n",
              static_cast<double>(stats.peak_kib) / 1024, static_cast<long>(stats.threads),
              static_cast<long>(stats.descriptors));
  return calls.failures() == 0;
}

}  // namespace affskel::load
