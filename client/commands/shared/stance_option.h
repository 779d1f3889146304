#pragma once

#include <CLI/App.hpp>

#include <string>

#include "client/base/stance.h"

namespace affskel::client {

/// --up, for pictures and pages.
void add_stance(CLI::App* command, std::string& up);

/// What it says.  @throws ClientError kUsage, see parse_stance.
StanceChoice chosen_stance(const std::string& up);

}  // namespace affskel::client
