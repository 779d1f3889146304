#include "metrics/endpoint.h"

#include <CivetServer.h>
#include <prometheus/text_serializer.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <future>
#include <stdexcept>
#include <utility>

#include "base/logfmt.h"
#include "base/mutex.h"

namespace affskel::server {
namespace {

// Between two calls that wake the library up.
constexpr std::chrono::milliseconds kKnock{5};

constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";
// The library goes on talking when it runs; nobody listens then.
constexpr std::size_t kMaxReasonBytes = 500;

constexpr const char* kPlainType = "text/plain; charset=utf-8";

[[noreturn]] void refuse(const wire::Address& address, const std::string& why) {
  throw std::runtime_error("cannot serve metrics on " + address.target() + ": " + why);
}

struct Answer {
  int code = 200;
  const char* type = kPlainType;
  std::string body;
};

/// Answers GET and HEAD of one path, and of none below it.
class Page final : public CivetHandler {
 public:
  Page(std::string path, std::function<Answer()> answer)
      : path_(std::move(path)), answer_(std::move(answer)) {}

  bool handleGet(CivetServer*, mg_connection* connection) override { return answer(connection, true); }
  bool handleHead(CivetServer*, mg_connection* connection) override { return answer(connection, false); }

 private:
  bool answer(mg_connection* connection, bool with_body) {
    if (path_ != mg_get_request_info(connection)->local_uri) return false;
    const Answer answer = made();
    mg_printf(connection,
              "HTTP/1.1 %d %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\nCache-Control: no-store\r\n"
              "Connection: close\r\n\r\n",
              answer.code, mg_get_response_code_text(connection, answer.code), answer.type,
              answer.body.size());
    if (with_body) mg_write(connection, answer.body.data(), answer.body.size());
    return true;
  }

  Answer made() {
    try {
      return answer_();
    } catch (const std::exception& error) {
      spdlog::warn(base::logfmt("metrics_failed", {{"path", path_}, {"message", error.what()}}));
      return {503, kPlainType, std::string(error.what()) + "\n"};
    }
  }

  const std::string path_;
  const std::function<Answer()> answer_;
};

/// What the library says while it starts is the reason when it does not.
struct Words {
  base::Mutex mutex;
  std::string text ABSL_GUARDED_BY(mutex);
};

int hear(const mg_connection* connection, const char* message) {
  const auto* const server = static_cast<const CivetServer*>(mg_get_user_data(mg_get_context(connection)));
  if (server == nullptr || server->getUserContext() == nullptr) return 1;
  auto& words = *static_cast<Words*>(const_cast<void*>(server->getUserContext()));
  const base::MutexLock lock(words.mutex);
  if (words.text.size() < kMaxReasonBytes)
    words.text += (words.text.empty() ? "" : "; ") + std::string(message);
  return 1;  // not to a file
}

}  // namespace

class MetricsEndpoint::Service {
 public:
  Service(const wire::Address& address, const EndpointSources& sources, const EndpointOptions& options)
      : address_(address),
        metrics_("/metrics",
                 [collect = sources.metrics] {
                   return Answer{200, kMetricsType, prometheus::TextSerializer().Serialize(collect())};
                 }),
        health_("/healthz", [trouble = sources.trouble] {
          const std::string why = trouble();
          return why.empty() ? Answer{200, kPlainType, "ok\n"} : Answer{503, kPlainType, why + "\n"};
        }) {
    start(options);
    http_->addHandler("/metrics", metrics_);
    http_->addHandler("/healthz", health_);
  }

  ~Service() {
    if (http_ == nullptr) return;
    auto closing = std::async(std::launch::async, [this] { http_->close(); });
    // The library looks up from its sockets every two seconds, or when somebody comes.
    while (closing.wait_for(kKnock) != std::future_status::ready) knock();
  }
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  const wire::Address& address() const { return address_; }

 private:
  void knock() const {
    char why[100];
    mg_connection* const visit = mg_connect_client(address_.host.c_str(), address_.port, 0, why, sizeof why);
    if (visit != nullptr) mg_close_connection(visit);
  }

  void start(const EndpointOptions& options) {
    CivetCallbacks callbacks;
    callbacks.log_message = hear;
    try {
      http_ = std::make_unique<CivetServer>(
          std::vector<std::string>{"listening_ports", address_.target(), "num_threads",
                                   std::to_string(options.threads), "request_timeout_ms",
                                   std::to_string(options.patience.count()), "enable_directory_listing",
                                   "no"},
          &callbacks, &words_);
    } catch (const CivetException& error) {
      const base::MutexLock lock(words_.mutex);
      refuse(address_, words_.text.empty() ? error.what() : words_.text);
    }
    address_.port = http_->getListeningPorts().at(0);
  }

  wire::Address address_;
  Words words_;
  Page metrics_;
  Page health_;
  std::unique_ptr<CivetServer> http_;  // last: its threads use all of the others
};

MetricsEndpoint::MetricsEndpoint(const wire::Address& address, EndpointSources sources,
                                 const EndpointOptions& options)
    : service_(std::make_unique<Service>(address, sources, options)) {}

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
