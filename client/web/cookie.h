#pragma once

#include <optional>
#include <string>

#include "http/message.h"

namespace affskel::client {

/// The Set-Cookie header that gives a browser the secret of its session.  Scripts do not see it, requests
/// from other sites do not carry it, and it ends with the browser.  Cookies know no ports, so that the name
/// does.
std::string session_cookie(int port, bool secure, const std::string& secret);
/// The one that takes it away.
std::string ended_cookie(int port, bool secure);

/// The secret that the request carries; nothing without one.
std::optional<std::string> session_secret(const http::Request& request, int port, bool secure);

}  // namespace affskel::client
