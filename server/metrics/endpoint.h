#pragma once

#include <prometheus/metric_family.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "http/limits.h"
#include "wire/address.h"

namespace affskel::server {

/// What an endpoint tells.  Both are called by its threads.
struct EndpointSources {
  std::function<std::vector<prometheus::MetricFamily>()> metrics;
  /// Why the server is of no use at the moment, or is about to close; empty when it is well.
  std::function<std::string()> trouble;
};

struct EndpointOptions {
  /// At a time; where there are more, those go that ask nothing.  With few of them newcomers wait for long, until
  /// those before them had the time to ask; see http::PlaceLimits::stay.
  std::size_t connections = 192;
  /// A peer that neither sends nor takes anything for so long is given up.
  std::chrono::milliseconds patience{5000};
};

/// What an endpoint takes of its peers.
http::Limits limits_of(const EndpointOptions& options);

/// Serves GET /metrics, in the text format of Prometheus, and GET /healthz, 200 or 503, over HTTP, without
/// asking for a name.  Has threads of its own, one for each of both: a peer that is slow to ask or to read
/// holds up no other.
class MetricsEndpoint {
 public:
  /// Listens and answers until destroyed.
  /// @param address HOST:PORT; port 0 takes any free one.
  /// @throws std::runtime_error naming address and cause.
  MetricsEndpoint(const wire::Address& address, EndpointSources sources, const EndpointOptions& options = {});
  ~MetricsEndpoint();
  MetricsEndpoint(const MetricsEndpoint&) = delete;
  MetricsEndpoint& operator=(const MetricsEndpoint&) = delete;

  /// Where it listens, with the port that it got.
  const wire::Address& address() const;

 private:
  class Service;
  std::unique_ptr<Service> service_;
};

/// Refuses an address that other machines reach, for metrics are shown to any caller, unless that is wanted,
/// and a Unix socket, for collectors know none.
/// @throws std::runtime_error naming the address and the cause.
void require_local_metrics(const wire::Address& address, bool insecure);

}  // namespace affskel::server
