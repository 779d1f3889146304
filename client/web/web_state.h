#pragma once

#include <memory>
#include <string>
#include <vector>

#include "client/operations/repair.h"
#include "client/web/backend.h"
#include "client/web/picture_cache.h"
#include "client/web/private_folder.h"
#include "client/web/request_guard.h"
#include "client/web/shelf.h"
#include "client/web/sign_in_brake.h"
#include "client/web/web_sessions.h"
#include "core/solid/solid.h"
#include "http/message.h"

namespace affskel::client {

/// How a service of the page is run.
struct WebOptions {
  /// True: the page is this machine's user's, who comes with a key and acts with the client's own identity.
  /// False: people sign in with their tokens, and the service does nothing without one.
  bool personal = true;
  bool secure = false;  ///< over TLS
  int port = 0;
  HostRule hosts;
  std::chrono::nanoseconds
      repair_limit{};  ///< processor time for reading, mending and checking a mesh; 0: any
};

/// A file that was made for a session to fetch.
struct ResultFile {
  std::unique_ptr<OwnedFile> file;
  std::string name;    ///< to save it under
  std::string type;    ///< Content-Type
  bool shown = false;  ///< by the browser, not saved
  std::string policy;  ///< Content-Security-Policy; empty = nothing is allowed
};

/// A mesh that was uploaded, to be submitted.
struct UploadedMesh {
  std::unique_ptr<OwnedFile> file;
  std::string name;  ///< of the file, for people
  core::Solid solid;
  std::unique_ptr<OwnedFile> source =
      nullptr;  ///< what it was before its repair; null where it was not repaired
  std::vector<core::RepairStep> steps = {};  ///< of the repair
};

/// What the handlers of requests share.  Thread-safe.
struct WebState {
  WebState(Backend server, WebOptions how) : backend(std::move(server)), options(std::move(how)) {}

  const Backend backend;
  const WebOptions options;
  WebSessions sessions;
  SignInBrake brake;
  PrivateFolder folder;  // above the files in it
  Shelf<ResultFile> results{{12, 1024, std::uint64_t{16} << 30, std::chrono::hours(1)}};
  Shelf<UploadedMesh> meshes{{2, 256, std::uint64_t{1} << 30, std::chrono::hours(2)}};

  PictureCache pictures{std::uint64_t{64} << 20};

  /// Forgets all that belongs to a session.
  void end_session(const std::string& id) {
    sessions.end(id);
    results.drop_session(id);
    meshes.drop_session(id);
  }
};

/// One request on its way to its answer.
struct WebCall {
  WebState& web;
  const http::Request& request;
  WebSessions::Found session;         ///< empty where the route asks for no sign-in
  std::string argument;               ///< the part of the path that the route leaves open
  std::unique_ptr<OwnedFile> upload;  ///< the body of an upload

  Session server() const {
    return session.user.token ? web.backend.session(*session.user.token, request.gone)
                              : web.backend.session(request.gone);
  }
  /// Gives the session a file to fetch; the answer names its address.
  std::string keep(ResultFile result) const;
};

}  // namespace affskel::client
