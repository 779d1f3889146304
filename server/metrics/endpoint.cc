#include "metrics/endpoint.h"

#include <prometheus/text_serializer.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "base/logfmt.h"
#include "http/server.h"

namespace affskel::server {
namespace {

constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";
constexpr const char* kPlainType = "text/plain; charset=utf-8";

[[noreturn]] void refuse(const wire::Address& address, const std::string& why) {
  throw std::runtime_error("cannot serve metrics on " + address.target() + ": " + why);
}

http::Response text(int status, const char* type, std::string body) {
  return {status, {{"Content-Type", type}}, std::move(body), {}, {}};
}

}  // namespace

http::Limits limits_of(const EndpointOptions& options) {
  http::Limits limits;
  limits.places = {.connections = options.connections, .for_known = 0};
  // Of each kind all connections may wait, and as many whose place has just gone to others and that leave in a
  // moment: every peer is answered.
  limits.waiting = limits.waiting_of_one = 2 * options.connections;
  // Health does not wait for metrics, which take longer; nothing computes.
  limits.threads = {{{1, 1}, {0, 1}, {1, 1}}};
  limits.header = limits.idle = limits.pace.window = options.patience;
  return limits;
}

class MetricsEndpoint::Service {
 public:
  Service(const wire::Address& address, EndpointSources sources, const EndpointOptions& options)
      : sources_(std::move(sources)), address_(address) {
    try {
      http_ = std::make_unique<http::Server>(
          address, nullptr, [this](const http::Request& head) { return admit(head); }, limits_of(options));
    } catch (const std::system_error& error) {
      refuse(address, error.code().message());
    }
    address_.port = http_->port();
    thread_ = std::thread([this] { http_->run(); });
  }

  ~Service() {
    http_->stop();
    thread_.join();
  }
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  const wire::Address& address() const { return address_; }

 private:
  std::variant<http::Response, http::Reception> admit(const http::Request& head) const {
    const bool health = head.path == "/healthz";
    if (!health && head.path != "/metrics") return text(404, kPlainType, "there is /metrics and /healthz\n");
    if (head.method != "GET" && head.method != "HEAD") {
      http::Response refusal = text(405, kPlainType, "this is to be read\n");
      refusal.headers.emplace_back("Allow", "GET, HEAD");
      return refusal;
    }
    http::Reception reception;
    reception.kind = health ? http::AnswerKind::kQuick : http::AnswerKind::kAwaited;
    reception.respond = [this, health](const http::Request& request) {
      try {
        return health ? health_answer() : metrics_answer();
      } catch (const std::exception& error) {
        spdlog::warn(base::logfmt("metrics_failed", {{"path", request.path}, {"message", error.what()}}));
        return text(503, kPlainType, std::string(error.what()) + "\n");
      }
    };
    return reception;
  }

  http::Response metrics_answer() const {
    return text(200, kMetricsType, prometheus::TextSerializer().Serialize(sources_.metrics()));
  }

  http::Response health_answer() const {
    const std::string why = sources_.trouble();
    return why.empty() ? text(200, kPlainType, "ok\n") : text(503, kPlainType, why + "\n");
  }

  const EndpointSources sources_;
  wire::Address address_;
  std::unique_ptr<http::Server> http_;
  std::thread thread_;
};

MetricsEndpoint::MetricsEndpoint(const wire::Address& address, EndpointSources sources,
                                 const EndpointOptions& options)
    : service_(std::make_unique<Service>(address, std::move(sources), options)) {}

MetricsEndpoint::~MetricsEndpoint() = default;

const wire::Address& MetricsEndpoint::address() const {
  return service_->address();
}

void require_local_metrics(const wire::Address& address, bool insecure) {
  if (address.is_unix) refuse(address, "expected HOST:PORT");
  if (address.is_local() || insecure) return;
  refuse(address,
         "other machines reach it, and nothing protects metrics: an address of this machine, or --insecure");
}

}  // namespace affskel::server
