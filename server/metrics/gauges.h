#pragma once

#include <prometheus/client_metric.h>
#include <prometheus/metric_family.h>

#include <string>
#include <vector>

namespace affskel::server {

/// Metrics that are read at the moment they are asked for: what is there now.
class Gauges {
 public:
  using Labels = std::vector<prometheus::ClientMetric::Label>;

  /// Begins a metric, to which the values that follow belong.
  /// @param name begins with affskel_, ends with the unit. @param help a sentence for people.
  Gauges& metric(std::string name, std::string help);

  /// Its value for these labels.
  Gauges& value(double value, Labels labels = {});

  /// All metrics; nothing is left.
  std::vector<prometheus::MetricFamily> take();

 private:
  std::vector<prometheus::MetricFamily> families_;
};

}  // namespace affskel::server
