#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "http/message.h"

namespace affskel::client {

/// Which names of this service a request may use for it.
struct HostRule {
  bool loopback = true;  ///< listens on a loopback address: localhost, 127.x.y.z and [::1] are its names
  std::function<bool(const std::string&)> certified;  ///< whether the certificate is for a name; empty = none
};

/// The host of a Host header, without its port and in lower case; of an IPv6 address without its brackets.
/// Nothing when it is malformed.
std::optional<std::string> host_name(std::string_view host);

/// Refuses what another site, or a name that leads here by another's DNS ("rebinding"), makes a browser send:
/// - the Host header is one of the service's own names;
/// - Sec-Fetch-Site, where the browser sends it, is same-origin, or none for what the user asked for by hand.
///   Other sites may at most link to the page itself, which holds nothing private;
/// - Origin is this service, and present wherever a request changes something.
/// @return the refusal; nothing when the request may pass.
std::optional<http::Response> refuse_foreign(const http::Request& request, const HostRule& rule);

}  // namespace affskel::client
