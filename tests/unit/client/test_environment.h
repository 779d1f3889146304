#pragma once

#include <map>
#include <string>

#include "client/connection/environment.h"

namespace affskel::client {

/// An environment with these variables and no others.
inline Environment test_environment(std::map<std::string, std::string> values) {
  return {[values = std::move(values)](const std::string& name) -> std::optional<std::string> {
    const auto found = values.find(name);
    if (found == values.end() || found->second.empty()) return std::nullopt;
    return found->second;
  }};
}

}  // namespace affskel::client
