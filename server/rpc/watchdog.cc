#include "rpc/watchdog.h"

#include <grpcpp/grpcpp.h>

#include <condition_variable>
#include <memory>
#include <utility>
#include <vector>

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

/// The calls of a round.  Shared with gRPC, which may keep a call for longer than anybody waits for it.
struct Round {
  explicit Round(std::size_t calls) : contexts(calls), responses(calls), pending(calls) {}

  std::vector<grpc::ClientContext> contexts;
  std::vector<v1::ReportResponse> responses;
  v1::RenewLeaseRequest request;
  base::Mutex mutex;
  std::condition_variable_any ended;
  std::size_t pending ABSL_GUARDED_BY(mutex);
  bool late ABSL_GUARDED_BY(mutex) = false;

  void end(const grpc::Status& status) {
    const base::MutexLock lock(mutex);
    late = late || status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
    if (--pending == 0) ended.notify_all();
  }
};

/// With a lease that nobody has.  Any answer is one: that it is refused, above all.
bool answers(v1::WorkerService::Stub& stub, const WatchdogOptions& options, const std::stop_token& stop) {
  const auto round = std::make_shared<Round>(options.calls);
  round->request.set_token(kWatchdogToken);
  for (std::size_t i = 0; i < round->contexts.size(); ++i) {
    grpc::ClientContext& context = round->contexts[i];
    context.set_wait_for_ready(true);
    context.set_deadline(std::chrono::system_clock::now() + options.patience);
    stub.async()->RenewLease(&context, &round->request, &round->responses[i],
                             [round](const grpc::Status& status) { round->end(status); });
  }
  const std::stop_callback cancel(stop, [&round] {
    for (grpc::ClientContext& context : round->contexts) context.TryCancel();
  });
  base::MutexLock lock(round->mutex);
  // Twice the deadline: gRPC may have lost the call's end, too.
  const bool ended = round->ended.wait_for(lock, 2 * options.patience, [&round] {
    round->mutex.assert_held();
    return round->pending == 0;
  });
  return ended && !round->late;
}

void watch(const std::string& target, const WatchdogOptions& options, const std::function<void()>& on_deaf,
           const std::stop_token& stop) {
  const auto stub = v1::WorkerService::NewStub(connect(target));
  base::Mutex mutex;
  std::condition_variable_any stopped;
  int strikes = 0;
  while (!stop.stop_requested()) {
    strikes = answers(*stub, options, stop) ? 0 : strikes + 1;
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
