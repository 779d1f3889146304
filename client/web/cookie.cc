#include "client/web/cookie.h"

namespace affskel::client {
namespace {

// With the prefix browsers take it over TLS only, and from this very host.
std::string cookie_name(int port, bool secure) {
  return (secure ? "__Host-affskel-" : "affskel-") + std::to_string(port);
}

std::string attributes(bool secure) {
  return std::string("; Path=/; HttpOnly; SameSite=Strict") + (secure ? "; Secure" : "");
}

}  // namespace

std::string session_cookie(int port, bool secure, const std::string& secret) {
  return cookie_name(port, secure) + "=" + secret + attributes(secure);
}

std::string ended_cookie(int port, bool secure) {
  return cookie_name(port, secure) + "=" + attributes(secure) + "; Max-Age=0";
}

std::optional<std::string> session_secret(const http::Request& request, int port, bool secure) {
  const auto header = request.header("cookie");
  const std::string name = cookie_name(port, secure) + "=";
  std::string_view rest = header.value_or("");
  while (!rest.empty()) {
    std::string_view pair = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    while (pair.starts_with(' ')) pair.remove_prefix(1);
    if (pair.starts_with(name)) return std::string(pair.substr(name.size()));
  }
  return std::nullopt;
}

}  // namespace affskel::client
