#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "../integration/lab.h"
#include "calls.h"
#include "loads.h"

namespace affskel::load {
namespace {

constexpr std::size_t kMeshBytes = std::size_t{16} << 20;
constexpr int kKills = 5;

/// Meshes that no worker can read, stored all the same.
void fill(v1::ErosionService::Stub& stub, int megabytes) {
  for (int i = 0; static_cast<std::size_t>(i) * kMeshBytes < static_cast<std::size_t>(megabytes) << 20; ++i) {
    std::string bytes(kMeshBytes, static_cast<char>('a' + i % 26));
    bytes += std::to_string(i);
    v1::Job job;
    submit(stub, bytes, "ballast " + std::to_string(i), &job);
    grpc::ClientContext context;
    v1::CancelJobRequest cancel;
    cancel.set_job(job.id());
    stub.CancelJob(&context, cancel, &job);
  }
}

}  // namespace

bool run_restart(const LoadOptions& options) {
  using Clock = std::chrono::steady_clock;
  const integration::Lab lab;
  integration::Process server = lab.server();
  fill(lab.stub(), options.megabytes);
  const integration::Process worker = lab.worker();
  lab.make_torus(2048);
  const std::string id =
      lab.submit({"--points", "100000", "--directions", "sphere:60000", "--priority", "9"});
  std::error_code none;
  std::printf("restart: database of %.0f MiB\n",
              static_cast<double>(std::filesystem::file_size(lab.path("data/affskel.db"), none)) / (1 << 20));
  for (int i = 0; i < kKills; ++i) {
    const std::uint64_t before =
        lab.follow(id, [](const v1::Job& job) { return job.directions_done() > 0; }).directions_done();
    // Just after a report, so that the next one is still being computed.
    const std::uint64_t at =
        lab.follow(id, [&](const v1::Job& job) { return job.directions_done() > before; }).directions_done();
    const Clock::time_point killed = Clock::now();
    server.kill_hard();
    server = lab.server();
    const double answers = std::chrono::duration<double>(Clock::now() - killed).count();
    const v1::Job job = lab.follow(id, [&](const v1::Job& now) { return now.directions_done() > at; });
    std::printf("kill -9: answers after %.2f s, next report accepted after %.2f s, %s\n", answers,
                std::chrono::duration<double>(Clock::now() - killed).count(),
                job.state() == v1::JOB_STATE_RUNNING ? "running" : "not running any more");
    if (job.state() != v1::JOB_STATE_RUNNING) return false;
  }
  std::printf("\n");
  return true;
}

}  // namespace affskel::load
