#pragma once

#include <map>
#include <memory>
#include <string>
#include <variant>

#include "base/mutex.h"
#include "client/web/web_state.h"

namespace affskel::client {

/// Answers the requests of the page: its files, and the interface that its script calls, in JSON.
/// Thread-safe.
class WebService {
 public:
  WebService(Backend backend, WebOptions options) : state_(std::move(backend), std::move(options)) {}

  /// See http::AdmitRequest.  Refuses other origins, what is not offered, and users that are not signed in.
  std::variant<http::Response, http::Reception> admit(const http::Request& head);

  /// See WebSessions::new_key.
  std::string new_key() { return state_.sessions.new_key(); }

  /// A new path in a folder that no other user can enter.
  std::filesystem::path new_private_path(const std::string& extension) {
    return state_.folder.new_path(extension);
  }

 private:
  class Place;
  using Whose = std::pair<http::AnswerKind, std::string>;  // a kind of answer, and an owner
  // Null when the owner has their part already.
  std::shared_ptr<Place> take_place(const Whose& whose);

  WebState state_;
  base::Mutex mutex_;
  std::map<Whose, unsigned> places_ ABSL_GUARDED_BY(mutex_);  // answers under way
};

}  // namespace affskel::client
