#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "client/base/up_axis.h"

namespace affskel::client {

/// --up, for pictures and pages.
void add_up(CLI::App* command, std::string& up);

/// The axis named "x", "y" or "z"; absent for an empty name: then the shape tells, see up_axis.
std::optional<UpAxis> chosen_up(const std::string& name);

}  // namespace affskel::client
