#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "client/base/error.h"
#include "client/web/http_message.h"

namespace affskel::client {

/// An answer in JSON.  Bytes that are no UTF-8 are replaced.
HttpResponse api_answer(const nlohmann::ordered_json& value, int status = 200);

/// {"error": {"code", "message"}}, as the command line prints it.
HttpResponse api_error(int status, const std::string& code, const std::string& message);

/// The same for a failed operation, with the line of the file where there is one; its status follows the
/// code.
HttpResponse api_error(const ClientError& error);

/// The request's body as a JSON object.  @throws ClientError kUsage when it is none.
nlohmann::json json_body(const HttpRequest& request);

/// Members of a request's object; `fallback` when absent or null.
/// @throws ClientError kUsage naming the member when it is of another type or a number that is not finite.
std::string text_member(const nlohmann::json& object, const char* name, const std::string& fallback = "");
double number_member(const nlohmann::json& object, const char* name, double fallback = 0);

}  // namespace affskel::client
