#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "affskel/v1/client_service.pb.h"
#include "client/base/notice.h"
#include "client/connection/environment.h"
#include "client/connection/server_choice.h"

namespace affskel::client {

/// How long to keep trying when a server that was there goes away.
struct RetryPolicy {
  std::chrono::milliseconds first_pause{100};
  std::chrono::milliseconds longest_pause{2000};
  std::chrono::milliseconds patience{5 * 60 * 1000};  ///< without any success
  /// Longest that a fetch waits for a worker and for all bytes; 0 = as long as it takes.
  std::chrono::milliseconds artifact_patience{0};
  std::chrono::milliseconds call_deadline{30000};  ///< of calls that answer at once
  std::chrono::milliseconds silence{5000};         ///< of such a call until it is told
  std::stop_token stop = {};                       ///< ends the calls and the pauses between them
};

/// What is submitted, OFF text.
struct GivenMeshes {
  std::string_view mesh;
  std::string_view source;  ///< before its repair; empty where it was not repaired
};

/// Receives one artefact.  A transfer that breaks off starts again with a new sink.
class ArtifactSink {
 public:
  virtual ~ArtifactSink() = default;
  virtual void begin(const v1::ArtifactHeader& header) = 0;
  virtual void data(std::string_view bytes) = 0;
  /// All bytes are there and their SHA-256 is right.
  virtual void end() = 0;
};

/// The connection to a server, and its calls.  A server that was never reached is an error at once; one
/// that answered may go away and come back, or have too much to do: calls that change nothing twice (all of
/// them) are then repeated with growing pauses, and the embedded server is started again.  All calls throw
/// ClientError. Not thread-safe.
class Session {
 public:
  /// @param listener hears that a private server was started, that the server is away or busy, and what
  ///   notify() passes on.
  Session(ServerChoice choice, Environment environment, Listener listener, RetryPolicy policy = {});
  ~Session();
  Session(Session&&) noexcept;

  /// Passes on what is to be known before the work is done.  From any thread.
  void notify(const Notice& notice) const;

  /// @param existed set to whether an earlier job answers this submission.
  v1::Job submit(const v1::SubmitJobHeader& header, const GivenMeshes& meshes, bool& existed);
  v1::Job get_job(const std::string& job);
  /// The newest `limit` jobs that the request is about, whatever its own limit; from as many answers as
  /// needed.
  std::vector<v1::Job> list_jobs(v1::ListJobsRequest request, std::size_t limit);
  /// Calls `seen` with every state of the job until a final one, which is returned; re-attaches when the
  /// stream breaks.
  v1::Job watch(const std::string& job, const std::function<void(const v1::Job&)>& seen);
  v1::Job cancel(const std::string& job);
  /// @param distrust a worker whose part is computed again by others; empty = none.
  v1::Job resume(const std::string& job, const std::string& distrust = {});
  /// Begins a verification (number 0), or tells how far one is.
  v1::Verification verify(const std::string& job, double share, std::uint64_t verification);
  v1::Job pin(const std::string& job);
  v1::Job unpin(const std::string& job);
  /// Keeps with the job how its solid stands; an empty stance: as its shape tells.
  v1::Job set_stance(const std::string& job, const v1::Stance& stance);
  std::string delete_job(const std::string& job);
  /// What happened to the job, oldest first.
  v1::ListJobEventsResponse job_events(const std::string& job);
  v1::ServerInfo server_info();
  /// The address of the server that was called last, as gRPC and --server take it; empty before the first call.
  std::string address() const;
  /// Asks the server's health service, once: for a check that is repeated by others.
  /// @throws ClientError kUnreachable when it does not answer within 3 s, or answers that it does not serve.
  void require_health();
  /// Checks size and SHA-256 of what arrives.
  v1::ArtifactHeader fetch(const v1::FetchArtifactRequest& request,
                           const std::function<std::unique_ptr<ArtifactSink>()>& make_sink);
  /// The whole artefact in memory.
  std::string fetch_bytes(const v1::FetchArtifactRequest& request, v1::ArtifactHeader* header = nullptr);

 private:
  class Link;  // keeps gRPC out of this header
  std::unique_ptr<Link> link_;
};

/// Whether nothing more will happen to the job by itself.
bool is_final(v1::JobState state);

}  // namespace affskel::client
