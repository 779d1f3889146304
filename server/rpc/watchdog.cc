#include "rpc/watchdog.h"

#include <grpcpp/grpcpp.h>

#include <condition_variable>
#include <utility>

#include "affskel/v1/worker_service.grpc.pb.h"
#include "base/mutex.h"

namespace affskel::server {
namespace {

std::shared_ptr<grpc::Channel> connect(const std::string& target) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(target, grpc::InsecureChannelCredentials(), arguments);
}

/// With a lease that nobody has.  Any answer is one: that it is refused, above all.
bool answers(v1::WorkerService::Stub& stub, std::chrono::milliseconds patience, const std::stop_token& stop) {
  grpc::ClientContext context;
  context.set_wait_for_ready(true);
  context.set_deadline(std::chrono::system_clock::now() + patience);
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  v1::RenewLeaseRequest request;
  request.set_token(kWatchdogToken);
  v1::ReportResponse response;
  return stub.RenewLease(&context, request, &response).error_code() != grpc::StatusCode::DEADLINE_EXCEEDED;
}

void watch(const std::string& target, const WatchdogOptions& options, const std::function<void()>& on_deaf,
           const std::stop_token& stop) {
  const auto stub = v1::WorkerService::NewStub(connect(target));
  base::Mutex mutex;
  std::condition_variable_any stopped;
  int strikes = 0;
  while (!stop.stop_requested()) {
    strikes = answers(*stub, options.patience, stop) ? 0 : strikes + 1;
    if (strikes >= options.strikes) return on_deaf();
    base::MutexLock lock(mutex);
    stopped.wait_for(lock, stop, options.period, [] { return false; });
  }
}

}  // namespace

Watchdog::Watchdog(const std::string& target, const WatchdogOptions& options, std::function<void()> on_deaf)
    : thread_([target, options, on_deaf = std::move(on_deaf)](const std::stop_token& stop) {
        watch(target, options, on_deaf, stop);
      }) {}

}  // namespace affskel::server
