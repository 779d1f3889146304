#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace affskel::http {

/// A request as it came over HTTP/1.1.
struct Request {
  std::string method;  ///< "GET", "POST", ...
  std::string path;    ///< percent-decoded, begins with '/'
  std::map<std::string, std::string> query;
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case
  std::string body;                                          ///< unless a file took it
  bool secure = false;                                       ///< over TLS
  std::string peer;                                          ///< see peer_key
  std::stop_token gone;                                      ///< when the answer is not waited for any more

  /// The value of the only header of this name (lower case); nothing when there is none or several.
  std::optional<std::string_view> header(std::string_view name) const;
  /// The value of the parameter; empty without one.
  std::string parameter(const std::string& name) const;
};

struct Response {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;
  std::filesystem::path file;  ///< sent instead of the body, unless empty
  std::shared_ptr<void> held;  ///< kept until all is sent
};

/// What an answer takes.  Each kind has threads of its own, so that none waits for another.  Answers that
/// are not quick are dropped when the peer closes its end.
enum class AnswerKind { kQuick, kComputed, kAwaited };

/// What becomes of an admitted request's body, and what answers then.
struct Reception {
  std::uint64_t max_bytes = 0;  ///< a longer body is refused with status 413
  std::string owner;            ///< the asker, where that is known: takes part in places and threads by it
  std::filesystem::path file;   ///< takes the body, unless empty: a new file
  AnswerKind kind = AnswerKind::kQuick;
  std::function<Response(const Request&)>
      respond;  ///< on a thread of its own; may wait until the request's peer has gone; must not throw
};

/// Decides by the head alone, at once, without waiting; called on one thread.
using AdmitRequest = std::function<std::variant<Response, Reception>(const Request& head)>;

/// The path and the query of a request target, decoded.  @return nothing when it is malformed.
struct RequestTarget {
  std::string path;
  std::map<std::string, std::string> query;
};
std::optional<RequestTarget> parse_target(std::string_view target);

}  // namespace affskel::http
