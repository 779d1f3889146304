#include "client/connection/call_errors.h"

namespace affskel::client {
namespace {

ExitCode exit_code_of(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::INVALID_ARGUMENT:
    case grpc::StatusCode::ALREADY_EXISTS:
    case grpc::StatusCode::OUT_OF_RANGE:
      return ExitCode::kUsage;
    case grpc::StatusCode::NOT_FOUND:
    case grpc::StatusCode::DATA_LOSS:  // what was stored is damaged: there is nothing to be had
      return ExitCode::kNotFound;
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::CANCELLED:  // by a server that closes; the client never cancels
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::ABORTED:
      return ExitCode::kUnreachable;
    case grpc::StatusCode::PERMISSION_DENIED:
    case grpc::StatusCode::UNAUTHENTICATED:
    case grpc::StatusCode::FAILED_PRECONDITION:
      return ExitCode::kNotAllowed;
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return ExitCode::kLimit;
    default:
      return ExitCode::kInternal;
  }
}

// So ends a connection in the clear to a server that speaks TLS.
bool may_want_tls(const std::string& server, const std::string& detail) {
  return !server.starts_with("unix:") && detail.find("Socket closed") != std::string::npos;
}

}  // namespace

ClientError error_from_status(const grpc::Status& status, const std::string& server, ExitCode not_yet) {
  const bool precondition = status.error_code() == grpc::StatusCode::FAILED_PRECONDITION;
  const ExitCode code = precondition ? not_yet : exit_code_of(status.error_code());
  const std::string detail = status.error_message();
  switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::CANCELLED:
      return {code, "cannot reach the server at " + server + ": " +
                        (may_want_tls(server, detail)
                             ? "it closed the connection; if it speaks TLS, name who signed its "
                               "certificate: --tls-ca"
                             : detail)};
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return {code, "the server at " + server + " did not answer in time"};
    case grpc::StatusCode::UNIMPLEMENTED:
      return {code, "the server at " + server + " does not offer this call (an older version?): " + detail};
    default:
      return {code, detail.empty() ? "the server answered with status " +
                                         std::to_string(static_cast<int>(status.error_code()))
                                   : detail};
  }
}

}  // namespace affskel::client
