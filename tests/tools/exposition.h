#pragma once

#include <map>
#include <string>
#include <vector>

namespace affskel::tests {

/// One value of a metric.
struct Sample {
  std::string name;  ///< with _bucket, _sum, _count for histograms
  std::map<std::string, std::string> labels;
  double value = 0;
};

/// A metric with its samples.
struct Exposed {
  std::string type;  ///< "counter", "gauge", "histogram"
  std::string help;
  std::vector<Sample> samples;
};

/// Reads the text exposition format of Prometheus, version 0.0.4, and refuses whatever Prometheus refuses or
/// its promtool warns of: a metric without HELP or TYPE before its samples, in two groups, or with the same
/// labels twice; names of counters without _total, and of others with it; names that end neither with a base
/// unit nor with what is counted; histograms whose buckets fall, do not end with +Inf, or disagree with their
/// count; counters that are negative or no number.
/// @throws std::runtime_error that names line and fault.
std::map<std::string, Exposed> read_exposition(const std::string& text);

/// The value of the sample with this name and these labels (all of them).  @throws std::out_of_range.
double value_of(const std::map<std::string, Exposed>& metrics, const std::string& name,
                const std::map<std::string, std::string>& labels = {});

}  // namespace affskel::tests
