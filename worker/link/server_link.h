#pragma once

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "affskel/v1/worker_service.grpc.pb.h"
#include "wire/channel.h"

namespace affskel::worker {

/// The lease is not ours any more (fenced, expired or cancelled): drop the task.
class LeaseLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The same, because an input of the task is damaged or cannot be read; the next task may fail for that, too.
class InputDamaged : public LeaseLost {
 public:
  using LeaseLost::LeaseLost;
};

/// The server refuses or stays away; the worker cannot go on.
class ServerGone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The server does not let this worker in: its token, certificate or role is not good for it.
class NotAllowed : public ServerGone {
 public:
  using ServerGone::ServerGone;
};

/// The call was ended early because its task is to stop.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ServerLinkOptions {
  std::string address;                ///< unix:PATH or HOST:PORT
  std::chrono::seconds patience{60};  ///< how long to wait for a server that does not answer
  std::string worker = {};            ///< its id: reports ask for other workers' bounds; empty: they do not
  wire::AccessFiles access = {};      ///< what it shows to the server
};

/// The worker's side of WorkerService.  All calls are safe to repeat: while the server is away, full or in
/// trouble they are made again, with growing pauses (see RetryPolicy).  Any thread.
class ServerLink {
 public:
  /// @throws std::invalid_argument when a file of options.access is not good.
  ServerLink(const ServerLinkOptions& options, std::stop_token stop);

  /// Waits for work up to request.wait_ms; nothing when there was none or the worker is to stop.
  /// @throws ServerGone.
  std::optional<v1::Lease> lease(const v1::LeaseTaskRequest& request);

  /// The bytes of one input of the leased task, checked against their SHA-256.
  /// @param stop ends the call early.  @throws LeaseLost, ServerGone, Interrupted.
  std::string fetch(const std::string& token, v1::ArtifactKind kind, const std::stop_token& stop = {},
                    const std::optional<std::uint32_t>& known_round = std::nullopt);

  /// Reports finished positions and field records.
  /// @param records messages that hold records, of either kind, only, at most wire::kRecordsPerMessage each.
  /// @throws LeaseLost, ServerGone.
  v1::ReportResponse report(const v1::ReportErosionHeader& header,
                            const std::vector<v1::ReportErosionRequest>& records);

  /// Hands in the result of a prepare or derive task.  @throws LeaseLost, ServerGone.
  v1::ReportResponse complete(v1::CompleteTaskHeader header, std::string_view data);

  v1::ReportResponse renew(const std::string& token);
  void fail(const v1::FailTaskRequest& request);

  /// Gives a lease back; errors are ignored, the lease expires anyway.
  void give_back(const std::string& token);

 private:
  struct Course;
  template <class Call>
  void with_retries(const char* what, Call call, const std::stop_token& task = {}, std::uint64_t bytes = 0);
  grpc::Status fetch_once(const v1::FetchInputRequest& request, grpc::ClientContext& context, Course& course,
                          std::string& bytes);
  void rest(std::chrono::milliseconds pause, const std::stop_token& stop);
  void note_answer(const grpc::Status& status);

  std::shared_ptr<grpc::Channel> channel_;  // of stub_
  std::unique_ptr<v1::WorkerService::Stub> stub_;
  ServerLinkOptions options_;
  std::stop_token stop_;
  std::atomic<std::uint64_t> seed_;  // of the pauses of the next call
  std::atomic<bool> away_ = false;   // whether the log says that the server is away
};

}  // namespace affskel::worker
