#include "tools/exposition.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace affskel::tests {
namespace {

// Base units, what is counted, or that there is no unit.
const std::vector<std::string> kUnits = {"_seconds", "_bytes",    "_total",       "_jobs",
                                         "_tasks",   "_leases",   "_workers",     "_threads",
                                         "_calls",   "_requests", "_connections", "_info"};

bool ends_with_one_of(const std::string& name, const std::vector<std::string>& ends) {
  return std::any_of(ends.begin(), ends.end(), [&](const std::string& end) { return name.ends_with(end); });
}

class Reader {
 public:
  std::map<std::string, Exposed> read(const std::string& text) {
    if (text.empty() || text.back() != '\n') fail("the last line has no end");
    std::istringstream lines(text);
    while (std::getline(lines, line_)) {
      ++number_;
      if (line_.starts_with("# HELP ")) {
        begin(line_.substr(7));
      } else if (line_.starts_with("# TYPE ")) {
        type(line_.substr(7));
      } else if (line_.starts_with("#") || line_.empty()) {
        fail("neither HELP, TYPE nor a sample");
      } else {
        sample();
      }
    }
    end();
    return std::move(metrics_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw std::runtime_error("line " + std::to_string(number_) + ": " + why + ": " + line_);
  }

  /// "NAME REST".
  std::pair<std::string, std::string> split(const std::string& text) const {
    const std::size_t space = text.find(' ');
    if (space == std::string::npos || space + 1 == text.size()) fail("nothing after the name");
    return {text.substr(0, space), text.substr(space + 1)};
  }

  void begin(const std::string& text) {
    end();
    const auto [name, help] = split(text);
    static const std::regex good("[a-zA-Z_][a-zA-Z0-9_]*");
    if (!std::regex_match(name, good)) fail("no name of a metric");
    if (!metrics_.emplace(name, Exposed{"", help, {}}).second) fail("a metric in two groups");
    name_ = name;
  }

  void type(const std::string& text) {
    const auto [name, type] = split(text);
    if (name != name_ || !metrics_[name_].type.empty() || !metrics_[name_].samples.empty())
      fail("TYPE out of place");
    if (type != "counter" && type != "gauge" && type != "histogram") fail("an unknown type");
    if (name.ends_with("_total") != (type == "counter")) fail("counters, and they alone, end with _total");
    if (!ends_with_one_of(name, kUnits)) fail("a name without a unit");
    metrics_[name_].type = type;
  }

  void sample() {
    static const std::regex form(R"re(([a-zA-Z_][a-zA-Z0-9_]*)(\{.*\})? (\S+))re");
    std::smatch parts;
    if (!std::regex_match(line_, parts, form)) fail("no sample");
    Sample one{parts[1], {}, 0};
    Exposed& metric = metrics_[name_];
    if (metric.type.empty()) fail("a sample before HELP and TYPE");
    const std::string suffix = one.name.starts_with(name_) ? one.name.substr(name_.size()) : "?";
    const bool fits = metric.type == "histogram"
                          ? suffix == "_bucket" || suffix == "_sum" || suffix == "_count"
                          : suffix.empty();
    if (!fits) fail("a sample of another metric");
    if (parts[2].matched) labels(parts[2].str(), one.labels);
    std::size_t used = 0;
    const std::string number = parts[3];
    one.value = std::stod(number, &used);
    if (used != number.size() || std::isnan(one.value)) fail("no number");
    if (metric.type != "gauge" && one.value < 0) fail("a count below 0");
    if (!seen_.insert({one.name, one.labels}).second) fail("the same labels twice");
    metric.samples.push_back(std::move(one));
  }

  /// "{a=\"b\",c=\"d\"}" with \\, \" and \n in values.
  void labels(const std::string& text, std::map<std::string, std::string>& to) const {
    std::size_t at = 1;
    while (text[at] != '}') {
      const std::size_t equals = text.find('=', at);
      if (equals == std::string::npos || text[equals + 1] != '"') fail("a label without a value");
      std::string value;
      std::size_t i = equals + 2;
      for (; i < text.size() && text[i] != '"'; ++i) {
        if (text[i] != '\\') {
          value += text[i];
          continue;
        }
        ++i;
        if (text[i] != 'n' && text[i] != '\\' && text[i] != '"') fail("an unknown escape");
        value += text[i] == 'n' ? '\n' : text[i];
      }
      if (!to.emplace(text.substr(at, equals - at), value).second) fail("a label twice");
      at = i + 1;
      if (at < text.size() && text[at] == ',') ++at;
      if (at >= text.size()) fail("labels without an end");
    }
    if (at + 1 != text.size()) fail("something after the labels");
  }

  /// The metric is complete.
  void end() {
    if (name_.empty()) return;
    const Exposed& metric = metrics_[name_];
    if (metric.type.empty()) fail(name_ + " has no TYPE");
    if (metric.type == "histogram") check_buckets(metric);
  }

  void check_buckets(const Exposed& metric) const {
    std::map<std::map<std::string, std::string>, std::vector<std::pair<double, double>>> buckets;
    std::map<std::map<std::string, std::string>, double> counts;
    for (const Sample& sample : metric.samples) {
      std::map<std::string, std::string> rest = sample.labels;
      rest.erase("le");
      if (sample.name.ends_with("_count")) counts[rest] = sample.value;
      if (!sample.name.ends_with("_bucket")) continue;
      buckets[rest].emplace_back(std::stod(sample.labels.at("le")), sample.value);
    }
    if (buckets.size() != counts.size()) fail("a histogram without buckets or count");
    for (const auto& [labels, rows] : buckets) {
      if (!std::is_sorted(rows.begin(), rows.end()) ||
          !std::is_sorted(rows.begin(), rows.end(), [](auto& a, auto& b) { return a.second < b.second; })) {
        fail(name_ + ": buckets out of order");
      }
      if (!std::isinf(rows.back().first) || rows.back().second != counts.at(labels)) {
        fail(name_ + ": the last bucket is not the count");
      }
    }
  }

  std::map<std::string, Exposed> metrics_;
  std::set<std::pair<std::string, std::map<std::string, std::string>>> seen_;
  std::string name_;
  std::string line_;
  std::size_t number_ = 0;
};

}  // namespace

std::map<std::string, Exposed> read_exposition(const std::string& text) {
  return Reader().read(text);
}

double value_of(const std::map<std::string, Exposed>& metrics, const std::string& name,
                const std::map<std::string, std::string>& labels) {
  for (const auto& [metric, exposed] : metrics) {
    for (const Sample& sample : exposed.samples) {
      if (sample.name == name && sample.labels == labels) return sample.value;
    }
  }
  throw std::out_of_range("no sample " + name);
}

}  // namespace affskel::tests
