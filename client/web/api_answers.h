#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "client/base/error.h"
#include "client/base/notice.h"
#include "client/operations/skeleton_choice.h"
#include "http/message.h"

namespace affskel::client {

/// An answer in JSON.  Bytes that are no UTF-8 are replaced.
http::Response api_answer(const nlohmann::ordered_json& value, int status = 200);

/// {"error": {"code", "message"}}, as the command line prints it.
http::Response api_error(int status, const std::string& code, const std::string& message);

/// The same for a failed operation, with the line of the file where there is one; its status follows the
/// code.
http::Response api_error(const ClientError& error);

/// Code, message and settings to try of each.
nlohmann::ordered_json notices_json(const Notices& notices);

/// The same of the warnings among them.
nlohmann::ordered_json warnings_json(const Notices& notices);

/// The request's body as a JSON object.  @throws ClientError kUsage when it is none.
nlohmann::json json_body(const http::Request& request);

/// Members of a request's object; `fallback` when absent or null.
/// @throws ClientError kUsage naming the member when it is of another type or a number that is not finite.
std::string text_member(const nlohmann::json& object, const char* name, const std::string& fallback = "");
double number_member(const nlohmann::json& object, const char* name, double fallback = 0);

/// The members "operator" and "threshold".
/// @throws ClientError kUsage as above, and for a threshold below 0.
SkeletonChoice skeleton_member(const nlohmann::json& object, const std::string& usual = "");

}  // namespace affskel::client
