#include "link/lease_keeper.h"
#include "base/mutex.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <stop_token>
#include <string>

namespace affskel::worker {
namespace {

using Why = TaskContext::Why;

// Renews the lease; tells why the task is to stop, or kGoesOn.
Why renew(ServerLink& link, const std::string& token) {
  try {
    return link.renew(token).cancelled() ? Why::kCancelled : Why::kGoesOn;
  } catch (const LeaseLost&) {
    return Why::kLeaseLost;
  }
}

void keep(ServerLink& link, const std::string& token, std::chrono::milliseconds interval,
          const std::stop_token& stop, TaskContext* context) {
  base::Mutex mutex;
  std::condition_variable_any wake;
  base::MutexLock lock(mutex);
  while (!wake.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
    try {
      const Why why = renew(link, token);
      if (why == Why::kGoesOn) continue;
      if (context != nullptr) context->stop(why);
      return;
    } catch (const std::exception&) {
      // A server that is back before the task has ended finds its lease kept; else the task's own calls tell.
    }
  }
}

// A quarter of the lease: it is renewed three times before it could end.
std::chrono::milliseconds renewal_interval(const v1::Lease& lease) {
  return std::chrono::milliseconds(std::max(1U, lease.lease_ms() / 4));
}

}  // namespace

LeaseKeeper::LeaseKeeper(ServerLink& link, const v1::Lease& lease)
    : thread_([&link, token = lease.token(), interval = renewal_interval(lease)](
                  const std::stop_token& stop) { keep(link, token, interval, stop, nullptr); }) {}

LeaseKeeper::LeaseKeeper(ServerLink& link, const v1::Lease& lease, TaskContext& context)
    : thread_([&link, &context, token = lease.token(),
               interval = std::min(renewal_interval(lease),
                                   std::chrono::milliseconds(std::max(1U, lease.report_interval_ms())))](
                  const std::stop_token& stop) { keep(link, token, interval, stop, &context); }) {}

}  // namespace affskel::worker
