#include "metrics/gauges.h"

#include <utility>

namespace affskel::server {

Gauges& Gauges::metric(std::string name, std::string help) {
  families_.push_back({std::move(name), std::move(help), prometheus::MetricType::Gauge, {}});
  return *this;
}

Gauges& Gauges::value(double value, Labels labels) {
  prometheus::ClientMetric& sample = families_.back().metric.emplace_back();
  sample.label = std::move(labels);
  sample.gauge.value = value;
  return *this;
}

std::vector<prometheus::MetricFamily> Gauges::take() {
  return std::exchange(families_, {});
}

}  // namespace affskel::server
