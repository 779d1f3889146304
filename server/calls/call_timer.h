#pragma once

#include <grpcpp/support/status.h>

#include <chrono>

#include "access/rules.h"
#include "metrics/metrics.h"

namespace affskel::server {

/// Tells the metrics how a call ended and how long it took, from the making of this object on.
class CallTimer {
 public:
  CallTimer(Metrics& metrics, Method method) : metrics_(metrics), method_(method) {}

  /// Called once.
  void ended(const grpc::Status& status) const;

 private:
  Metrics& metrics_;
  const Method method_;
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace affskel::server
