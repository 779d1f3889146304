#include "closed_queue.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <random>

namespace affskel::load {
namespace {

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

ClosedQueueResult simulate_closed_queue(const std::vector<double>& service,
                                        const ClosedQueueOptions& options) {
  std::mt19937_64 random(options.seed);
  std::uniform_int_distribution<std::size_t> draw(0, service.size() - 1);
  std::uniform_real_distribution<double> phase(0, options.think);
  // Answers come in the order of the calls, so that times of calls are all that is waiting.
  std::priority_queue<double, std::vector<double>, std::greater<>> calls;
  for (int c = 0; c < options.callers; ++c) calls.push(phase(random));
  std::vector<double> responses;
  double free = 0, busy = 0;  // when the server is free next; how long it has served
  while (calls.top() < options.duration) {
    const double called = calls.top();
    calls.pop();
    const double time = service[draw(random)];
    free = std::max(free, called) + time;
    calls.push(free + options.think);
    if (called < options.warm_up) continue;
    busy += time;
    responses.push_back(free - called);
  }
  const double counted = options.duration - options.warm_up;
  ClosedQueueResult result;
  result.calls_per_second = static_cast<double>(responses.size()) / counted;
  result.utilisation = std::min(1.0, busy / counted);
  result.response_median = quantile(responses, 0.5);
  result.response_p99 = quantile(responses, 0.99);
  return result;
}

}  // namespace affskel::load
