#include <algorithm>
#include <optional>

#include "client/operations/fetch.h"
#include "client/text/message_json.h"
#include "client/text/word_texts.h"
#include "client/text/words.h"
#include "client/web/api_answers.h"
#include "client/web/cookie.h"
#include "client/web/handlers.h"
#include "core/files/read/parse_shape.h"
#include "wire/params.h"
#include "wire/version.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

// What metadata of gRPC can hold; the server knows what is a token.
bool may_be_token(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c > 0x20 && c < 0x7f; });
}

WebUser user_of(Session server, std::shared_ptr<const base::MemoryFile> token) {
  const v1::ServerInfo info = server.server_info();
  return {std::move(token), info.caller().owner(), info.caller().role() == v1::ROLE_ADMIN,
          info.max_mesh_bytes()};
}

// By the token that they show.  A server that takes any token would let any caller do everything.
// @throws ClientError kNotAllowed when the server refuses it, or would refuse none.
WebUser signed_in_user(const WebState& web, const std::string& text) {
  if (!web.backend.refuses_strangers()) {
    throw ClientError(
        ExitCode::kNotAllowed,
        "the server asks nobody for a token, so that nobody can sign in here; see affskel-server "
        "token --help");
  }
  auto token = std::make_shared<const base::MemoryFile>("the token", text);
  Session server = web.backend.session(*token);
  return user_of(std::move(server), std::move(token));
}

// The same, and tells the brake.  @throws ClientError.
WebUser braked_user(WebState& web, const std::string& peer, const std::string& text) {
  try {
    WebUser user = signed_in_user(web, text);
    web.brake.was_right(peer, text);
    return user;
  } catch (const ClientError& error) {
    if (error.exit_code() == ExitCode::kNotAllowed) {
      web.brake.was_wrong(text);
    } else {
      web.brake.was_not_seen(peer);
    }
    throw;
  }
}

http::Response come_again(SignInBrake::Clock::duration time) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(time).count();
  http::Response response =
      api_error(429, "LIMIT", "too many wrong tokens from your address; try again in a moment");
  response.headers.emplace_back("Retry-After", std::to_string(seconds));
  return response;
}

ordered_json offered_artifacts() {
  ordered_json artifacts = ordered_json::array();
  for (const std::string& name : artifact_names()) {
    if (name == "surface") continue;  // the skeleton, for scripts
    artifacts.push_back({{"name", name}, {"formats", artifact_extensions(name)}});
  }
  return artifacts;
}

ordered_json sheet_operators() {
  ordered_json sheets = ordered_json::array();
  for (const std::string& word : operator_words())
    if (wire::gives_sheet(operator_named(word))) sheets.push_back(word);
  return sheets;
}

// A page sends one file of each mesh.
std::vector<std::string_view> mesh_files() {
  std::vector<std::string_view> extensions = core::mesh_extensions();
  const std::vector<std::string_view> clouds = core::cloud_extensions();
  extensions.insert(extensions.end(), clouds.begin(), clouds.end());
  return extensions;
}

ordered_json session_json(const WebState& web, const WebUser& user) {
  return {{"mode", web.options.personal ? "personal" : "sign-in"},
          {"signed_in", true},
          {"version", wire::kVersion},
          {"owner", user.owner.empty() ? web.backend.own_user() : user.owner},
          {"admin", user.admin},
          {"max_mesh_bytes", user.max_mesh_bytes},
          {"words", word_texts()},
          {"usual",
           {{"operator", operator_word(v1::OPERATOR_UNSPECIFIED)},
            {"frame", frame_word(v1::FRAME_UNSPECIFIED)},
            {"minimum", minimum_word(v1::MINIMUM_UNSPECIFIED)}}},
          {"sheets", sheet_operators()},
          {"artefacts", offered_artifacts()},
          {"mesh_files", mesh_files()},
          {"voxel_files", core::voxel_extensions(core::VoxelFiles::kWhole)},
          {"packed_files", core::packed_extensions()}};
}

// This machine's user for a key, which stays new while the server cannot be asked; nobody when it is none.
std::optional<WebUser> user_of_key(WebState& web, const std::string& key) {
  if (!web.sessions.use_key(key)) return std::nullopt;
  try {
    return user_of(web.backend.session(), nullptr);
  } catch (...) {
    web.sessions.give_back(key);
    throw;
  }
}

}  // namespace

http::Response answer_session(WebCall& call) {
  if (!call.session.id.empty()) return api_answer(session_json(call.web, call.session.user));
  return api_answer({{"mode", call.web.options.personal ? "personal" : "sign-in"}, {"signed_in", false}});
}

http::Response begin_session(WebCall& call) {
  WebState& web = call.web;
  const nlohmann::json body = json_body(call.request);
  std::optional<WebUser> user;
  if (!web.options.personal) {
    const std::string token = text_member(body, "token");
    if (!may_be_token(token)) throw ClientError(ExitCode::kNotAllowed, "this is no token");
    if (const auto time = web.brake.put_off(call.request.peer, token)) return come_again(*time);
    user = braked_user(web, call.request.peer, token);
  } else {
    user = user_of_key(web, text_member(body, "key"));
  }
  if (!user)
    return api_error(401, "NOT_ALLOWED", "this address has been used before, or is not of this service");
  const auto secret = web.sessions.begin(*user);
  if (!secret) return api_error(503, "LIMIT", "too many people are signed in; try again later");
  http::Response response = api_answer(session_json(web, *user));
  response.headers.emplace_back("Set-Cookie", session_cookie(web.options.port, web.options.secure, *secret));
  return response;
}

http::Response end_session(WebCall& call) {
  call.web.end_session(call.session.id);
  http::Response response = api_answer({{"signed_in", false}});
  response.headers.emplace_back("Set-Cookie", ended_cookie(call.web.options.port, call.web.options.secure));
  return response;
}

http::Response answer_server(WebCall& call) {
  const v1::ServerInfo info = call.server().server_info();
  return api_answer(to_json(info));
}

}  // namespace affskel::client
