#include "calls.h"

#include <algorithm>
#include <cstdio>

#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::load {
namespace {

double percentile(const std::vector<double>& sorted, double share) {
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(share * last)];
}

}  // namespace

void Calls::add(const std::string& name, std::chrono::steady_clock::duration time,
                const grpc::Status& status) {
  const std::lock_guard lock(mutex_);
  times_ms_[name].push_back(std::chrono::duration<double, std::milli>(time).count());
  if (!status.ok()) {
    ++failures_[name + ": " + std::to_string(status.error_code()) + " " + status.error_message()];
  }
}

void Calls::print() const {
  const std::lock_guard lock(mutex_);
  std::printf("%-12s %8s %10s %10s %10s\n", "call", "number", "p50 ms", "p99 ms", "max ms");
  for (auto [name, times] : times_ms_) {
    std::sort(times.begin(), times.end());
    std::printf("%-12s %8zu %10.2f %10.2f %10.2f\n", name.c_str(), times.size(), percentile(times, 0.5),
                percentile(times, 0.99), times.back());
  }
  for (const auto& [what, number] : failures_) std::printf("failed %zu times: %s\n", number, what.c_str());
}

void Calls::forget_times() {
  const std::lock_guard lock(mutex_);
  times_ms_.clear();
}

std::size_t Calls::failures() const {
  const std::lock_guard lock(mutex_);
  std::size_t sum = 0;
  for (const auto& [what, number] : failures_) sum += number;
  return sum;
}

std::shared_ptr<grpc::Channel> connect(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

grpc::Status submit(v1::ErosionService::Stub& stub, const std::string& mesh, const std::string& name,
                    v1::Job* job, double spacing) {
  grpc::ClientContext context;
  context.set_wait_for_ready(true);
  v1::SubmitJobResponse response;
  const auto writer = stub.SubmitJob(&context, &response);
  v1::SubmitJobRequest request;
  v1::SubmitJobHeader& header = *request.mutable_header();
  header.set_name(name);
  header.set_priority(5);
  header.mutable_params()->mutable_sampling()->set_spacing(spacing);
  header.mutable_params()->set_repair(true);
  header.set_mesh_sha256(wire::sha256_hex(mesh));
  header.set_mesh_bytes(mesh.size());
  writer->Write(request);
  for (std::size_t at = 0; at < mesh.size(); at += wire::kChunkBytes) {
    request.set_data(mesh.substr(at, wire::kChunkBytes));
    writer->Write(request);
  }
  writer->WritesDone();
  const grpc::Status status = writer->Finish();
  *job = response.job();
  return status;
}

}  // namespace affskel::load
