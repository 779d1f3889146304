#include "client/web/api_answers.h"

#include <cmath>

#include "base/utf8.h"
#include "client/text/message_json.h"

namespace affskel::client {
namespace {

int status_of(ExitCode code) {
  switch (code) {
    case ExitCode::kDone:
      return 200;
    case ExitCode::kUsage:
      return 400;
    case ExitCode::kBadInput:
      return 422;
    case ExitCode::kNotFound:
      return 404;
    case ExitCode::kJobFailed:
    case ExitCode::kCancelled:
      return 409;
    case ExitCode::kNotAllowed:
      return 403;
    case ExitCode::kUnreachable:
      return 503;
    case ExitCode::kLimit:
      return 507;
    case ExitCode::kClosedPipe:
    case ExitCode::kInternal:
      return 500;
  }
  return 500;
}

[[noreturn]] void wrong_type(const char* name, const char* wanted) {
  throw ClientError(ExitCode::kUsage, std::string("'") + name + "' must be " + wanted);
}

}  // namespace

http::Response api_answer(const nlohmann::ordered_json& value, int status) {
  http::Response response;
  response.status = status;
  response.headers = {{"Content-Type", "application/json"}};
  response.body = value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return response;
}

http::Response api_error(int status, const std::string& code, const std::string& message) {
  return api_answer({{"error", {{"code", code}, {"message", message}}}}, status);
}

http::Response api_error(const ClientError& error) {
  nlohmann::ordered_json body = {{"code", exit_code_name(error.exit_code())}, {"message", error.what()}};
  if (error.line() > 0) body["line"] = error.line();
  return api_answer({{"error", body}}, status_of(error.exit_code()));
}

nlohmann::ordered_json notices_json(const Notices& notices) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Notice& notice : notices) {
    nlohmann::ordered_json to_try = nlohmann::ordered_json::array();
    for (const v1::Setting& setting : notice.to_try) to_try.push_back(to_json(setting));
    list.push_back({{"code", notice.code}, {"message", notice.message}, {"to_try", to_try}});
  }
  return list;
}

nlohmann::ordered_json warnings_json(const Notices& notices) {
  Notices warnings = notices;
  std::erase_if(warnings, [](const Notice& notice) { return notice.kind != Notice::Kind::kWarning; });
  return notices_json(warnings);
}

nlohmann::json json_body(const http::Request& request) {
  const nlohmann::json body = nlohmann::json::parse(request.body, nullptr, false);
  if (!body.is_object()) throw ClientError(ExitCode::kUsage, "the request is no JSON object");
  return body;
}

std::string text_member(const nlohmann::json& object, const char* name, const std::string& fallback) {
  const auto found = object.find(name);
  if (found == object.end() || found->is_null()) return fallback;
  if (!found->is_string()) wrong_type(name, "a text");
  std::string text = found->get<std::string>();
  if (!base::is_utf8(text)) wrong_type(name, "UTF-8");
  return text;
}

double number_member(const nlohmann::json& object, const char* name, double fallback) {
  const auto found = object.find(name);
  if (found == object.end() || found->is_null()) return fallback;
  if (!found->is_number() || !std::isfinite(found->get<double>())) wrong_type(name, "a number");
  return found->get<double>();
}

SkeletonChoice skeleton_member(const nlohmann::json& object, const std::string& usual) {
  return {text_member(object, "operator", usual), number_member(object, "threshold")};
}

}  // namespace affskel::client
