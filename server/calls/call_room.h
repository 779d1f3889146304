#pragma once

#include <grpcpp/server_context.h>

#include <memory>
#include <optional>

#include "access/gate.h"
#include "access/rules.h"
#include "calls/activity.h"
#include "calls/answers.h"
#include "calls/call_limit.h"
#include "calls/executor.h"
#include "calls/limits.h"
#include "calls/upload_budget.h"
#include "metrics/metrics.h"
#include "traffic/connections.h"

namespace affskel::server {

/// What the calls of a server share: connections, places, threads and memory.
struct CallRoom {
  /// @param upload_bytes of meshes and results in memory at once.
  CallRoom(const CallLimits& limits, std::uint64_t upload_bytes);

  /// Ends what is too slow.  Call now and then.
  void tick();

  /// Ends the calls of tokens that are good no longer, and writes down when tokens were used.  Call now and
  /// then.
  void tick_gate();

  /// Uploads have no memory left: ends the one that holds most for its pace.
  void relieve_uploads();

  /// The server is about to close: calls that wait end, and no stream of a client begins any more.
  void close();

  /// Runs what was posted, and ends the threads; for when no call is under way.
  void stop();

  const CallLimits limits;
  Metrics metrics;           ///< of all that has happened
  std::optional<Gate> gate;  ///< set before any call comes
  Activity activity;         ///< of clients

  // Threads: the calls of one kind never wait for those of another.
  Executor client_calls;    ///< short ones
  Executor client_streams;  ///< uploads and downloads
  Executor worker_calls;    ///< reports and all that is short
  Executor worker_inputs;   ///< inputs of tasks, which may take long to open

  Connections connections;
  Answers answers;
  UploadBudget upload_bytes;
  UploadBudget records_bytes;
  CallLimit uploads;
  CallLimit downloads;
  CallLimit waiting;
  CallLimit watches;
  CallLimit reports;
  CallLimit results;
  CallLimit inputs;
  CallLimit polls;
};

/// What every call has: its connection, and for a client's call its share in the server's activity.
class CallScope {
 public:
  /// @throws CallEnded when the connection has no room for it, or the caller no right to it.
  CallScope(CallRoom& room, const grpc::CallbackServerContext& context, Method method);

  const Caller& caller() const { return call_.caller(); }

 private:
  Connections::Call call_;
  std::unique_ptr<Activity::Call> activity_;
};

/// Why calls end when the server closes.
inline grpc::Status shutting_down() {
  return {grpc::StatusCode::UNAVAILABLE, "the server is shutting down"};
}

}  // namespace affskel::server
