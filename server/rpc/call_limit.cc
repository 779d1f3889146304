#include "rpc/call_limit.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <limits>

#include "rpc/status.h"

namespace affskel::server {
namespace {

// Of the descriptors, these are never a client connection's: what downloads, workers' inputs, the log and the
// database need.  With few of them, a quarter.
constexpr std::uint64_t kReserved = 256;

// An idle connection costs some tens of kilobytes, whatever the limit on descriptors is.
constexpr std::uint64_t kMostConnections = 16384;

}  // namespace

CallLimits limits_for(std::uint64_t open_files) {
  CallLimits limits;
  // Two descriptors to a download, so that all of them together take an eighth.
  limits.downloads = std::clamp<std::uint64_t>(open_files / 16, 1, limits.downloads);
  const std::uint64_t reserve = std::min(kReserved, open_files / 4);
  limits.connections = static_cast<int>(std::min(open_files - reserve, kMostConnections));
  return limits;
}

std::uint64_t open_files_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return std::numeric_limits<std::uint32_t>::max();
  }
  return std::max<std::uint64_t>(1, limit.rlim_cur);
}

CallLimit::Place::Place(CallLimit& limit)
    : limit_(limit), holder_{nullptr, std::chrono::steady_clock::now()} {
  if (limit_.enter(holder_)) return;
  throw CallEnded({grpc::StatusCode::UNAVAILABLE, std::to_string(limit_.most_) + " " + limit_.what_ +
                                                      " are under way, the most that this server has at "
                                                      "once; try again"});
}

CallLimit::Place::~Place() {
  {
    const std::lock_guard lock(limit_.mutex_);
    limit_.holders_.remove(&holder_);
  }
  limit_.freed_.notify_one();
}

void CallLimit::Place::depend_on_client(grpc::ServerContextBase& context) {
  const std::lock_guard lock(limit_.mutex_);
  holder_ = {&context, std::chrono::steady_clock::now()};
}

void CallLimit::Place::progress() {
  const std::lock_guard lock(limit_.mutex_);
  holder_.progress = std::chrono::steady_clock::now();
}

bool CallLimit::enter(Holder& holder) {
  const auto now = [] { return std::chrono::steady_clock::now(); };
  std::unique_lock lock(mutex_);
  const auto free = [this] { return holders_.size() < most_; };
  if (!free() && !evict(now()) && !freed_.wait_for(lock, patience_, free) && !evict(now())) return false;
  holders_.push_back(&holder);
  return true;
}

/// Ends the call that has stood still for longest, if that is too long.
bool CallLimit::evict(std::chrono::steady_clock::time_point now) {
  const auto later = [](const Holder* a, const Holder* b) {
    // Those that cannot be ended come last.
    return (a->context == nullptr) != (b->context == nullptr) ? b->context == nullptr
                                                              : a->progress < b->progress;
  };
  const auto slowest = std::min_element(holders_.begin(), holders_.end(), later);
  if (slowest == holders_.end() || (*slowest)->context == nullptr) return false;
  if (now - (*slowest)->progress < stall_) return false;
  spdlog::warn("event=stalled_call_ended kind={} peer={} stalled_ms={}", what_, (*slowest)->context->peer(),
               std::chrono::duration_cast<std::chrono::milliseconds>(now - (*slowest)->progress).count());
  (*slowest)->context->TryCancel();
  holders_.erase(slowest);
  return true;
}

}  // namespace affskel::server
