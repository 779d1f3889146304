#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "../integration/lab.h"
#include "calls.h"
#include "loads.h"
#include "made_up_worker.h"
#include "tools/let_pass.h"

namespace affskel::load {
namespace {

constexpr int kPinnedOneIn = 100;
constexpr auto kPace = std::chrono::milliseconds(20);
constexpr int kMaxPaces = 30'000;  // ten minutes

std::vector<std::string> computed_jobs(const integration::Lab& lab, int number) {
  const auto stub = v1::ErosionService::NewStub(connect(lab.address()));
  Calls calls;
  std::vector<std::string> ids;
  const MadeUpWorkerOptions worker{.address = lab.address(),
                                   .id = "made-up",
                                   .points = 2000,
                                   .directions = 8,
                                   .pause = std::chrono::milliseconds(0)};
  const std::jthread works([&](const std::stop_token& stop) { run_made_up_worker(worker, stop, calls); });
  for (int i = 0; i < number; ++i) {
    const std::string mesh = "mesh " + std::to_string(i);
    v1::Job job;
    if (const grpc::Status status = submit(*stub, mesh, mesh, &job); !status.ok())
      throw std::runtime_error("submission failed: " + status.error_message());
    ids.push_back(job.id());
    // In step with the worker: this is no load of a long queue.
    lab.follow_to_end(ids[static_cast<std::size_t>(std::max(0, i - 8))]);
  }
  lab.follow_to_end(ids.back());
  return ids;
}

/// Asks again and again until it holds, as people look at a list.  @returns whether it ever held.
template <typename Condition>
bool in_time(Condition&& holds) {
  for (int i = 0; i < kMaxPaces; ++i) {
    if (holds()) return true;
    tests::let_pass(kPace);
  }
  return false;
}

double mebibytes(const integration::Lab& lab) {
  return static_cast<double>(std::filesystem::file_size(lab.path("data/affskel.db"))) / (1024 * 1024);
}

}  // namespace

bool run_retention(const LoadOptions& options) {
  const integration::Lab lab;
  std::vector<std::string> ids;
  {
    integration::Process server = lab.server();
    ids = computed_jobs(lab, options.jobs);
    for (std::size_t i = 0; i < ids.size(); i += kPinnedOneIn) lab.client({"pin", ids[i]});
    server.send(SIGTERM);
    server.wait();
  }
  const double before = mebibytes(lab);
  const auto begin = std::chrono::steady_clock::now();
  const integration::Process server =
      lab.server({"--retention", "results-age=1s", "--retention", "grace=1s"});
  const auto stub = v1::ErosionService::NewStub(connect(lab.address()));
  Calls calls;
  bool all = true;
  std::size_t pinned = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto get = [&](v1::Job& job) {
      return calls.timed("get", [&] {
        grpc::ClientContext context;
        v1::GetJobRequest request;
        request.set_job(ids[i]);
        return stub->GetJob(&context, request, &job);
      });
    };
    v1::Job job;
    if (i % kPinnedOneIn == 0) {
      pinned += get(job) && job.pinned() && job.removed_ms() == 0 ? 1 : 0;
    } else {
      all = all && in_time([&] { return !get(job) || job.removed_ms() > 0; }) && job.removed_ms() > 0;
    }
  }
  const std::chrono::duration<double> removed = std::chrono::steady_clock::now() - begin;
  const bool shrunk = in_time([&] { return mebibytes(lab) < before / 2; });
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const std::size_t pins = (ids.size() + kPinnedOneIn - 1) / kPinnedOneIn;
  std::printf("retention: results of %zu jobs removed after %.1f s, %zu of %zu pinned ones there\n",
              ids.size() - pins, removed.count(), pinned, pins);
  std::printf("database %.1f MiB before, %.1f MiB after %.1f s\n", before, mebibytes(lab), took.count());
  calls.print();
  std::printf("\n");
  return all && shrunk && pinned == pins && calls.failures() == 0;
}

}  // namespace affskel::load
