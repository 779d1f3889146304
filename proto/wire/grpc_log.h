#pragma once

#include <string>

namespace affskel::wire {

/// Makes what gRPC has to say entries of a program's own log, as long as it lives.  There is one at a time,
/// and it ends before the log does: gRPC's threads go on until the process ends.  What protobuf finds wrong with bytes
/// is told by the call that carried them, and not logged: a peer could fill the log with it.
class GrpcLog {
 public:
  /// @param entry in logfmt.  Called by any thread.
  using Sink = void (*)(bool is_error, const std::string& entry);

  explicit GrpcLog(Sink sink);
  ~GrpcLog();
  GrpcLog(const GrpcLog&) = delete;
  GrpcLog& operator=(const GrpcLog&) = delete;
};

}  // namespace affskel::wire
