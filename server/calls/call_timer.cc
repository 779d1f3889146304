#include "calls/call_timer.h"

#include "calls/status.h"

namespace affskel::server {

void CallTimer::ended(const grpc::Status& status) const {
  metrics_.call_ended(rule_of(method_).name, code_name(status.error_code()),
                      std::chrono::steady_clock::now() - begun_);
}

}  // namespace affskel::server
