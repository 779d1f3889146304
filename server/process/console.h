#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/exit_code.h"

namespace affskel::server {

/// Where commands on a data directory write: results to stdout, everything for people to stderr.
class Console {
 public:
  /// @param json one JSON document instead of lines, errors as JSON.
  explicit Console(bool json) : json_(json) {}

  bool json() const { return json_; }

  /// An object, as "key: value" lines or as JSON.  @throws base::OutputError.
  void result(const nlohmann::ordered_json& document) const;
  /// Text for stdout.  @throws base::OutputError.
  void print(const std::string& text) const;
  void error(base::ExitCode code, const std::string& message) const;
  /// Of the database, found by check.
  void fault(const std::string& message) const;
  /// For people only.
  void note(const std::string& message) const;

 private:
  void report(const char* name, const std::string& message) const;

  bool json_;
};

}  // namespace affskel::server
