#include "lease_keeper.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <string>

namespace affskel::worker {
namespace {

void keep(ServerLink& link, const std::string& token, std::chrono::milliseconds interval,
          const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock<std::mutex> lock(mutex);
  while (!wake.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
    try {
      if (link.renew(token).cancelled()) return;
    } catch (const std::exception&) {
      return;
    }
  }
}

}  // namespace

// Three times before it runs out.
LeaseKeeper::LeaseKeeper(ServerLink& link, const v1::Lease& lease)
    : thread_([&link, token = lease.token(),
               interval = std::chrono::milliseconds(std::max(1U, lease.lease_ms() / 4))](
                  const std::stop_token& stop) { keep(link, token, interval, stop); }) {}

}  // namespace affskel::worker
