#include "client/web/request_guard.h"

#include <algorithm>

#include "base/lower_case.h"
#include "client/web/api_answers.h"

namespace affskel::client {
namespace {

bool is_loopback_name(const std::string& name) {
  const auto numeric = [&] {
    return std::all_of(name.begin(), name.end(), [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
  };
  return name == "localhost" || name == "::1" || (name.starts_with("127.") && numeric());
}

bool is_known_host(const std::string& name, const HostRule& rule) {
  return (rule.loopback && is_loopback_name(name)) || (rule.certified && rule.certified(name));
}

// Whether another site's link, or a line typed by the user, asks for the page.
bool opens_page(const http::Request& request) {
  return request.method == "GET" && request.path == "/" &&
         request.header("sec-fetch-mode").value_or("") == "navigate" &&
         request.header("sec-fetch-dest").value_or("") == "document";
}

bool is_foreign_site(const http::Request& request) {
  const auto site = request.header("sec-fetch-site");
  if (!site || *site == "same-origin" || (*site == "none" && request.method == "GET")) return false;
  return !opens_page(request);
}

}  // namespace

std::optional<std::string> host_name(std::string_view host) {
  std::string_view name = host, port;
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    name = host.substr(1, end - 1);
    port = host.substr(end + 1);
  } else if (const std::size_t colon = host.find(':'); colon != std::string_view::npos) {
    name = host.substr(0, colon);
    port = host.substr(colon);
  }
  const bool port_is_fine = port.empty() || (port.size() > 1 && port[0] == ':' &&
                                             std::all_of(port.begin() + 1, port.end(),
                                                         [](char c) { return c >= '0' && c <= '9'; }));
  if (name.empty() || !port_is_fine) return std::nullopt;
  return base::lower_case(name);
}

std::optional<http::Response> refuse_foreign(const http::Request& request, const HostRule& rule) {
  const auto host = request.header("host");
  const auto name = host ? host_name(*host) : std::nullopt;
  if (!name || !is_known_host(*name, rule))
    return api_error(421, "NOT_ALLOWED",
                     "this service does not go by the name '" + std::string(host.value_or("")) + "'");
  if (is_foreign_site(request)) return api_error(403, "NOT_ALLOWED", "another site may not use this service");
  const bool changes = request.method != "GET" && request.method != "HEAD";
  const std::string own = (request.secure ? "https://" : "http://") + std::string(*host);
  const auto origin = request.header("origin");
  const bool several = !origin && std::any_of(request.headers.begin(), request.headers.end(),
                                              [](const auto& field) { return field.first == "origin"; });
  if (several || (origin && *origin != own) || (!origin && changes))
    return api_error(403, "NOT_ALLOWED", "the request comes from another origin, or does not say from which");
  return std::nullopt;
}

}  // namespace affskel::client
