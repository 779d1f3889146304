#include "services/watchdog.h"

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

/// How the calls of a round ended.  Shared with gRPC, which may keep a call for longer than it is waited
/// for.
class Outcome {
 public:
  explicit Outcome(std::size_t calls) : pending_(calls) {}

  void end(const grpc::Status& status) {
    const base::MutexLock lock(mutex_);
    late_ = late_ || status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
    if (--pending_ == 0) ended_.notify_all();
  }
  bool ended() const {
    const base::MutexLock lock(mutex_);
    return pending_ == 0;
  }
  bool answered(std::chrono::milliseconds patience) {
    base::MutexLock lock(mutex_);
    const bool ended = ended_.wait_for(lock, patience, [this] {
      mutex_.assert_held();
      return pending_ == 0;
    });
    return ended && !late_;
  }

 private:
  mutable base::Mutex mutex_;
  std::condition_variable_any ended_;
  std::size_t pending_ ABSL_GUARDED_BY(mutex_);
  bool late_ ABSL_GUARDED_BY(mutex_) = false;
};

/// The calls of a round.  Its contexts hold the channel, and the thread that drops the last of them joins
/// gRPC's threads: so the watchdog's thread must, and never a call's end, which runs on one of those
/// threads.
struct Round {
  explicit Round(std::size_t calls)
      : contexts(calls), responses(calls), outcome(std::make_shared<Outcome>(calls)) {}

  std::vector<grpc::ClientContext> contexts;
  std::vector<v1::ReportResponse> responses;
  v1::RenewLeaseRequest request;
  std::shared_ptr<Outcome> outcome;
};

/// With a lease that no worker has.  Any answer is one: that it is refused, above all.
bool answers(v1::WorkerService::Stub& stub, Round& round, const WatchdogOptions& options,
             const std::stop_token& stop) {
  round.request.set_token(kWatchdogToken);
  for (std::size_t i = 0; i < round.contexts.size(); ++i) {
    grpc::ClientContext& context = round.contexts[i];
    context.set_wait_for_ready(true);
    context.set_deadline(std::chrono::system_clock::now() + options.patience);
    stub.async()->RenewLease(&context, &round.request, &round.responses[i],
                             [outcome = round.outcome](const grpc::Status& status) { outcome->end(status); });
  }
  const std::stop_callback cancel(stop, [&round] {
    for (grpc::ClientContext& context : round.contexts) context.TryCancel();
  });
  // Twice the deadline: gRPC may have lost the call's end, too.
  return round.outcome->answered(2 * options.patience);
}

/// The rounds of which gRPC has not ended every call.
class OpenRounds {
 public:
  OpenRounds() = default;
  OpenRounds(const OpenRounds&) = delete;
  OpenRounds& operator=(const OpenRounds&) = delete;
  /// What gRPC has lost may still be written to: it is left to the process.
  ~OpenRounds() {
    drop_ended();
    for (std::unique_ptr<Round>& round : rounds_) static_cast<void>(round.release());
  }
  Round& begin(std::size_t calls) {
    drop_ended();
    return *rounds_.emplace_back(std::make_unique<Round>(calls));
  }

 private:
  void drop_ended() {
    std::erase_if(rounds_, [](const std::unique_ptr<Round>& round) { return round->outcome->ended(); });
  }

  std::vector<std::unique_ptr<Round>> rounds_;
};

void watch(const std::string& target, const WatchdogOptions& options, const std::function<void()>& on_deaf,
           const std::stop_token& stop) {
  const auto stub = v1::WorkerService::NewStub(connect(target));
  OpenRounds rounds;
  base::Mutex mutex;
  std::condition_variable_any stopped;
  int strikes = 0;
  while (!stop.stop_requested()) {
    strikes = answers(*stub, rounds.begin(options.calls), options, stop) ? 0 : strikes + 1;
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
