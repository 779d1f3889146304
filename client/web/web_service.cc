#include "client/web/web_service.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "base/utf8.h"
#include "client/files/format.h"
#include "client/web/api_answers.h"
#include "client/web/cookie.h"
#include "client/web/handlers.h"
#include "client/web/page_files.h"

namespace affskel::client {
namespace {

// Callers that a route admits.
enum class Access { kEverybody, kSignedIn, kAdmin };

// What a request may carry.
enum class Body { kNone, kObject, kMesh };

struct Route {
  const char* method;
  const char* path;  // '*' stands for one part
  Access access;
  Body body;
  http::AnswerKind kind;
  http::Response (*respond)(WebCall& call);
};

constexpr std::array<Route, 25> kRoutes = {{
    {"GET", "/", Access::kEverybody, Body::kNone, http::AnswerKind::kQuick, send_page_file},
    {"GET", "/page.js", Access::kEverybody, Body::kNone, http::AnswerKind::kQuick, send_page_file},
    {"GET", "/page.css", Access::kEverybody, Body::kNone, http::AnswerKind::kQuick, send_page_file},
    {"GET", "/icon.svg", Access::kEverybody, Body::kNone, http::AnswerKind::kQuick, send_page_file},
    {"GET", "/api/session", Access::kEverybody, Body::kNone, http::AnswerKind::kQuick, answer_session},
    {"POST", "/api/session", Access::kEverybody, Body::kObject, http::AnswerKind::kQuick, begin_session},
    {"DELETE", "/api/session", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, end_session},
    {"GET", "/api/server", Access::kAdmin, Body::kNone, http::AnswerKind::kQuick, answer_server},
    {"GET", "/api/jobs", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, list_jobs},
    {"POST", "/api/jobs", Access::kSignedIn, Body::kObject, http::AnswerKind::kComputed, submit_mesh},
    {"GET", "/api/jobs/*", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, show_job},
    {"DELETE", "/api/jobs/*", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, delete_job},
    {"POST", "/api/jobs/*/cancel", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, cancel_job},
    {"POST", "/api/jobs/*/resume", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, resume_job},
    {"POST", "/api/jobs/*/pin", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, pin_job},
    {"POST", "/api/jobs/*/unpin", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, unpin_job},
    {"POST", "/api/jobs/*/stance", Access::kSignedIn, Body::kObject, http::AnswerKind::kQuick, set_stance},
    {"GET", "/api/jobs/*/events", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, list_events},
    {"POST", "/api/jobs/*/results", Access::kSignedIn, Body::kObject, http::AnswerKind::kAwaited,
     make_result},
    {"GET", "/api/jobs/*/thumbnail", Access::kSignedIn, Body::kNone, http::AnswerKind::kAwaited,
     send_thumbnail},
    {"POST", "/api/archives", Access::kSignedIn, Body::kObject, http::AnswerKind::kAwaited, make_archive},
    {"POST", "/api/meshes", Access::kSignedIn, Body::kMesh, http::AnswerKind::kComputed, take_mesh},
    {"POST", "/api/meshes/view", Access::kSignedIn, Body::kMesh, http::AnswerKind::kComputed, turn_mesh},
    {"GET", "/api/meshes/*/lattice", Access::kSignedIn, Body::kNone, http::AnswerKind::kComputed,
     lay_lattice},
    {"GET", "/results/*", Access::kSignedIn, Body::kNone, http::AnswerKind::kQuick, send_result},
}};

constexpr std::uint64_t kMaxObjectBytes = 64 * 1024;
// Of one owner at a time, of answers that wait for workers: others find threads, too.
constexpr unsigned kMaxAwaited = 4;
// The same of those that compute here.
constexpr unsigned kMaxComputed = 2;

// What '*' stands for, empty without one; nothing when the path is another.
std::optional<std::string> match(std::string_view pattern, std::string_view path) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == path ? std::optional<std::string>("") : std::nullopt;
  const std::string_view before = pattern.substr(0, star), after = pattern.substr(star + 1);
  if (path.size() <= before.size() + after.size() || !path.starts_with(before) || !path.ends_with(after))
    return std::nullopt;
  const std::string_view part = path.substr(before.size(), path.size() - before.size() - after.size());
  return part.find('/') == std::string_view::npos ? std::optional<std::string>(part) : std::nullopt;
}

struct Chosen {
  const Route* route = nullptr;
  std::string argument;
  std::string methods;  // of the path
};

// HEAD is answered as GET is; the conversation leaves the body out.
Chosen choose_route(const http::Request& head) {
  const std::string_view method = head.method == "HEAD" ? "GET" : std::string_view(head.method);
  Chosen chosen;
  for (const Route& route : kRoutes) {
    const auto argument = match(route.path, head.path);
    if (!argument) continue;
    const std::string_view name = route.method;
    chosen.methods += (chosen.methods.empty() ? "" : ", ") + std::string(name == "GET" ? "GET, HEAD" : name);
    if (method != name) continue;
    chosen.route = &route;
    chosen.argument = *argument;
  }
  return chosen;
}

http::Response no_such_route(const Chosen& chosen) {
  if (chosen.methods.empty()) return api_error(404, "NOT_FOUND", "there is nothing at this address");
  http::Response refusal = api_error(405, "USAGE", "this address takes " + chosen.methods);
  refusal.headers.emplace_back("Allow", chosen.methods);
  return refusal;
}

http::Response sign_in_first() {
  return api_error(401, "NOT_ALLOWED", "nobody is signed in, or the session has ended: sign in again");
}

// Whether the server still takes the token of a session.
bool is_still_known(const WebCall& call) {
  try {
    call.server().server_info();
  } catch (const ClientError& error) {
    return error.exit_code() != ExitCode::kNotAllowed;
  }
  return true;
}

http::Response answer_error(const WebCall& call, const ClientError& error) {
  const bool may_have_ended =
      error.exit_code() == ExitCode::kNotAllowed && call.session.user.token != nullptr;
  if (!may_have_ended || is_still_known(call)) return api_error(error);
  call.web.end_session(call.session.id);
  return sign_in_first();
}

http::Response answer(WebCall& call, const Route& route) {
  try {
    return route.respond(call);
  } catch (const ClientError& error) {
    return answer_error(call, error);
  } catch (const base::FileError& error) {
    return api_error(error_from_file(error));
  } catch (const core::CoreError& error) {
    return api_error(error_from_core(error, ""));
  } catch (const std::bad_alloc&) {
    return api_error(ClientError(ExitCode::kLimit, "there is not enough memory for this"));
  } catch (const std::exception& error) {
    return api_error(ClientError(ExitCode::kInternal, std::string("internal error: ") + error.what()));
  }
}

// The reader goes by the extension.
std::string upload_extension(const http::Request& head) {
  constexpr std::size_t kLongest = 8;
  const std::string extension = lower_extension(head.parameter("name"));
  const bool usual = extension.size() > 1 && extension.size() <= kLongest &&
                     std::all_of(extension.begin() + 1, extension.end(),
                                 [](unsigned char c) { return std::isalnum(c) != 0 && c < 0x80; });
  return usual ? extension : ".off";
}

}  // namespace

// One place among the threads that compute or wait for workers, given back when it is destroyed.
class WebService::Place {
 public:
  Place(WebService& service, Whose whose) : service_(service), whose_(std::move(whose)) {}
  ~Place() {
    const base::MutexLock lock(service_.mutex_);
    const auto own = service_.places_.find(whose_);
    if (--own->second == 0) service_.places_.erase(own);
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

 private:
  WebService& service_;
  const Whose whose_;
};

std::shared_ptr<WebService::Place> WebService::take_place(const Whose& whose) {
  const base::MutexLock lock(mutex_);
  unsigned& own = places_[whose];
  if (own == (whose.first == http::AnswerKind::kAwaited ? kMaxAwaited : kMaxComputed)) return nullptr;
  ++own;
  return std::make_shared<Place>(*this, whose);
}

std::variant<http::Response, http::Reception> WebService::admit(const http::Request& head) {
  if (auto refusal = refuse_foreign(head, state_.options.hosts)) return *refusal;
  const Chosen chosen = choose_route(head);
  if (chosen.route == nullptr) return no_such_route(chosen);
  const Route& route = *chosen.route;
  if (!base::is_utf8(chosen.argument)) return api_error(400, "USAGE", "the address is not UTF-8");
  const auto secret = session_secret(head, state_.options.port, state_.options.secure);
  const auto found = secret ? state_.sessions.find(*secret) : std::nullopt;
  if (route.access != Access::kEverybody && !found) return sign_in_first();
  const WebSessions::Found session = found.value_or(WebSessions::Found());
  if (route.access == Access::kAdmin && !session.user.admin)
    return api_error(403, "NOT_ALLOWED", "this is for administrators");

  if (route.access == Access::kEverybody && route.body == Body::kNone) {
    WebCall call{state_, head, session, chosen.argument, nullptr};
    return answer(call, route);
  }

  http::Reception reception;
  reception.kind = route.kind;
  if (found) reception.owner = "'" + session.user.owner + "'";
  auto upload = std::make_shared<std::unique_ptr<OwnedFile>>();
  if (route.body == Body::kObject) reception.max_bytes = kMaxObjectBytes;
  if (route.body == Body::kMesh) {
    reception.max_bytes = session.user.max_mesh_bytes;
    reception.file = state_.folder.new_path(upload_extension(head));
    *upload = std::make_unique<OwnedFile>(reception.file);
  }
  std::shared_ptr<Place> place;
  if (route.kind != http::AnswerKind::kQuick && !(place = take_place({route.kind, reception.owner})))
    return api_error(429, "LIMIT",
                     route.kind == http::AnswerKind::kAwaited
                         ? "wait for the files that are being made for you; " + std::to_string(kMaxAwaited) +
                               " are made at a time"
                         : "wait for the meshes that are being looked at for you; " +
                               std::to_string(kMaxComputed) + " are looked at at a time");
  reception.respond = [this, &route, argument = chosen.argument, session, upload,
                       place](const http::Request& request) {
    WebCall call{state_, request, session, argument, std::move(*upload)};
    http::Response response = answer(call, route);
    // What a mesh took goes back to the system; by itself the C library keeps it for its threads.
    if (route.kind != http::AnswerKind::kQuick) malloc_trim(0);
    return response;
  };
  return reception;
}

}  // namespace affskel::client
