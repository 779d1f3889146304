#pragma once

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "affskel/v1/client_service.grpc.pb.h"
#include "affskel/v1/worker_service.grpc.pb.h"
#include "wire/channel.h"

namespace affskel::chaos {

using Milliseconds = std::chrono::milliseconds;

/// Nothing answered, or nothing went on, for as long as patience lasts.
struct Hang : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// For whatever must come in the end: long enough for a loaded machine, and for a server that tries a full
/// disk again once a minute.
constexpr Milliseconds kPatience{300000};

/// A submission as the driver makes it.  Names and request ids are never used for two of them.
struct Submission {
  std::string name;
  std::string request_id;
  std::string mesh;  ///< OFF text
  std::string mesh_sha256;
  v1::ErosionParams params;
  v1::Operator skeleton = v1::OPERATOR_UNSPECIFIED;
  std::uint32_t priority = 5;
  std::size_t recipe = 0;  ///< what its field must equal
};

/// Whether a call may be made again: the server is away, closing, full or slow, and not of another opinion;
/// or the token was revoked, which a fault does, and then gives another.
bool worth_repeating(const grpc::Status& status);

bool is_final(const v1::Job& job);

/// The service's calls with a time limit each.  Thread-safe.
class Api {
 public:
  /// @param address `unix:PATH` or `HOST:PORT`.
  /// @param access what is shown to the server.
  explicit Api(const std::string& address, const wire::AccessFiles& access = {});

  v1::ErosionService::Stub& client() const { return *client_; }
  v1::WorkerService::Stub& worker() const { return *worker_; }

  grpc::Status submit(const Submission& submission, v1::SubmitJobResponse& response,
                      Milliseconds limit) const;
  grpc::Status job(const std::string& id, v1::Job& job, Milliseconds limit) const;
  grpc::Status cancel(const std::string& id, v1::Job& job, Milliseconds limit) const;
  grpc::Status resume(const std::string& id, v1::Job& job, Milliseconds limit) const;
  grpc::Status remove(const std::string& id, Milliseconds limit) const;
  grpc::Status info(v1::ServerInfo& info, Milliseconds limit) const;
  /// All jobs, newest first.
  grpc::Status list(std::vector<v1::Job>& jobs, Milliseconds limit) const;
  /// One artefact; `bytes` is all of it, of the right length, when the status is OK.
  grpc::Status fetch(const v1::FetchArtifactRequest& request, std::string& bytes, Milliseconds limit) const;

  /// Follows a job until the condition holds or its state is final, across whatever happens to the server.
  /// @throws Hang after `limit`.
  v1::Job follow(const std::string& id, const std::function<bool(const v1::Job&)>& condition,
                 Milliseconds limit = kPatience) const;

 private:
  std::unique_ptr<v1::ErosionService::Stub> client_;
  std::unique_ptr<v1::WorkerService::Stub> worker_;
};

/// Calls until the answer is not one to repeat.
/// @throws Hang after kPatience, naming `what`.
grpc::Status until_answered(const std::string& what, const std::function<grpc::Status()>& call);

v1::FetchArtifactRequest artefact(const std::string& job, v1::ArtifactKind kind);

}  // namespace affskel::chaos
