#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "../integration/lab.h"
#include "calls.h"
#include "loads.h"
#include "wire/sha256.h"

namespace affskel::load {
namespace {

constexpr const char* kPoints = "100000";
// A block takes about a second: a job must be several, for turns to show.
constexpr int kDirectionsPerSecond = 4000;

/// Submits a job that takes as long as all others: the same mesh and other directions.
std::string submit_as(v1::ErosionService::Stub& stub, const std::string& owner, const std::string& mesh,
                      int directions, int seed) {
  grpc::ClientContext context;
  v1::SubmitJobResponse response;
  const auto writer = stub.SubmitJob(&context, &response);
  v1::SubmitJobRequest message;
  v1::SubmitJobHeader& header = *message.mutable_header();
  header.set_owner(owner);
  header.set_name(owner);
  header.set_priority(5);
  header.mutable_params()->mutable_sampling()->set_target_points(std::stoull(kPoints));
  header.mutable_params()->set_directions("random:" + std::to_string(directions) + ":" +
                                          std::to_string(seed));
  header.set_mesh_sha256(wire::sha256_hex(mesh));
  header.set_mesh_bytes(mesh.size());
  writer->Write(message);
  message.set_data(mesh);
  writer->Write(message);
  writer->WritesDone();
  const grpc::Status status = writer->Finish();
  if (!status.ok()) throw std::runtime_error("submission failed: " + status.error_message());
  return response.job().id();
}

double seconds(std::uint64_t from_ms, std::uint64_t to_ms) {
  return static_cast<double>(to_ms - from_ms) / 1000;
}

}  // namespace

bool run_turns(const LoadOptions& options) {
  const integration::Lab lab;
  const integration::Process server = lab.server();
  std::vector<integration::Process> workers;
  for (int i = 0; i < std::min(options.workers, 2); ++i) workers.push_back(lab.worker({"--threads", "1"}));
  const auto stub = v1::ErosionService::NewStub(connect(lab.address()));
  lab.run({AFFSKEL_CLIENT_BINARY, "make", "torus", "--triangles", "2048", "-o", lab.path("m.off")});
  const std::string mesh = lab.read("m.off");
  const int directions = kDirectionsPerSecond * options.seconds;
  const v1::Job idle = lab.follow_to_end(submit_as(*stub, "bob", mesh, directions, 0));
  const int jobs = std::min(options.jobs, 1000);
  std::string first;
  for (int i = 1; i <= jobs; ++i) {
    const std::string id = submit_as(*stub, "ada", mesh, directions, i);
    if (first.empty()) first = id;
  }
  lab.follow(first, [](const v1::Job& job) { return job.directions_done() > 0; });
  const v1::Job busy = lab.follow_to_end(submit_as(*stub, "bob", mesh, directions, jobs + 1));
  const double alone = seconds(idle.created_ms(), idle.finished_ms());
  const double beside = seconds(busy.created_ms(), busy.finished_ms());
  std::printf("turns: %d jobs of another owner wait, %zu workers\n", jobs, workers.size());
  std::printf("alone %.2f s, beside them %.2f s (started after %.2f s): %.2f times\n\n", alone, beside,
              seconds(busy.created_ms(), busy.started_ms()), beside / alone);
  return idle.state() == v1::JOB_STATE_DONE && busy.state() == v1::JOB_STATE_DONE;
}

}  // namespace affskel::load
