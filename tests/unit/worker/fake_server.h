#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "affskel/v1/worker_service.grpc.pb.h"
#include "tools/temporary_directory.h"

namespace affskel::worker {

/// A WorkerService on a Unix socket in a temporary directory: hands out the leases it is given, keeps
/// what workers send, and fails calls on demand.
class FakeServer final : public v1::WorkerService::Service {
 public:
  FakeServer();
  ~FakeServer() override;

  std::string address() const;
  /// The same service on a loopback address.
  std::string tcp_address() const;

  /// To be handed out, in this order; nothing when they are used up.
  void offer(const v1::Lease& lease);
  /// What FetchInput sends.
  void set_input(v1::ArtifactKind kind, const std::string& bytes);
  /// The next calls of `method` ("LeaseTask", ...) end with this status.
  void fail_next(const std::string& method, const grpc::Status& status, int times = 1);
  /// The next FetchInput goes on, without any bytes, until the worker ends the call.
  void hold_next_fetch();
  /// The next RenewLease says that the task was cancelled; with a fetch to be held, the next once that is.
  void cancel_next_renewal();
  /// The next FetchInput flips a byte on the way.
  void damage_next_fetch();
  /// Called for every report that is accepted; its answer is sent.
  void on_report(std::function<v1::ReportResponse(const v1::ReportErosionHeader&)> answer);

  struct Report {
    v1::ReportErosionHeader header;
    v1::FieldRecords records;
    v1::RefinedRecords refined;
  };
  struct Completion {
    v1::CompleteTaskHeader header;
    std::string data;
    std::chrono::system_clock::duration time_left{};  ///< to the call's deadline, when it began
  };
  std::vector<Report> reports() const;
  std::vector<Completion> completions() const;
  std::vector<v1::FailTaskRequest> failures() const;
  std::vector<v1::LeaseTaskRequest> lease_requests() const;
  /// How often a method was called, failed calls included.
  int calls(const std::string& method) const;
  /// Waits for the first call of a method.
  void wait_for_call(const std::string& method) const;
  /// Waits until a worker that has nothing else to do is told that there is no work.
  void wait_for_idle() const;

 private:
  grpc::Status LeaseTask(grpc::ServerContext*, const v1::LeaseTaskRequest*, v1::LeaseTaskResponse*) override;
  grpc::Status RenewLease(grpc::ServerContext*, const v1::RenewLeaseRequest*, v1::ReportResponse*) override;
  grpc::Status ReportErosion(grpc::ServerContext*, grpc::ServerReader<v1::ReportErosionRequest>*,
                             v1::ReportResponse*) override;
  grpc::Status CompleteTask(grpc::ServerContext*, grpc::ServerReader<v1::CompleteTaskRequest>*,
                            v1::ReportResponse*) override;
  grpc::Status FailTask(grpc::ServerContext*, const v1::FailTaskRequest*, v1::ReportResponse*) override;
  grpc::Status ReturnLease(grpc::ServerContext*, const v1::ReturnLeaseRequest*, v1::ReportResponse*) override;
  grpc::Status FetchInput(grpc::ServerContext*, const v1::FetchInputRequest*,
                          grpc::ServerWriter<v1::FetchArtifactResponse>*) override;

  bool take_hold();

  // Counts the call; the status that was asked for, or OK.
  grpc::Status begin(const std::string& method);

  tests::TemporaryDirectory dir_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  // All guarded by mutex_.
  std::deque<v1::Lease> leases_;
  std::vector<std::pair<v1::ArtifactKind, std::string>> inputs_;
  std::deque<std::pair<std::string, grpc::Status>> failures_to_come_;
  std::vector<std::string> calls_;
  bool damage_next_ = false;
  bool hold_next_ = false;
  bool cancel_next_renewal_ = false;
  bool idle_ = false;
  std::function<v1::ReportResponse(const v1::ReportErosionHeader&)> answer_;
  std::vector<Report> reports_;
  std::vector<Completion> completions_;
  std::vector<v1::FailTaskRequest> failures_;
  std::vector<v1::LeaseTaskRequest> lease_requests_;
};

}  // namespace affskel::worker
