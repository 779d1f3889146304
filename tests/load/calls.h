#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "affskel/v1/client_service.grpc.pb.h"
#include "affskel/v1/worker_service.grpc.pb.h"

namespace affskel::load {

/// How long calls took, by name, and how those ended that failed.  Thread-safe.
class Calls {
 public:
  /// Runs a call and keeps its time.  @returns whether it succeeded.
  template <typename Call>
  bool timed(const std::string& name, Call&& call) {
    const auto start = std::chrono::steady_clock::now();
    const grpc::Status status = call();
    add(name, std::chrono::steady_clock::now() - start, status);
    return status.ok();
  }

  /// Keeps the time of a call that was made otherwise.
  void add(const std::string& name, std::chrono::steady_clock::duration time, const grpc::Status& status);

  /// One line for each name: number, median, 99th percentile and longest in milliseconds; then the failures.
  void print() const;

  /// From now on only later calls are told; failures are kept.
  void forget_times();

  std::size_t failures() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<double>> times_ms_;
  std::map<std::string, std::size_t> failures_;
};

/// A connection of its own, as a program of its own would have.
std::shared_ptr<grpc::Channel> connect(const std::string& address);

/// Submits bytes as a mesh, whatever they are.
grpc::Status submit(v1::ErosionService::Stub& stub, const std::string& mesh, const std::string& name,
                    v1::Job* job, double spacing = 0.25);

}  // namespace affskel::load
