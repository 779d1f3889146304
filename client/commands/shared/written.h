#pragma once

#include <nlohmann/json_fwd.hpp>

#include "client/cli/console.h"
#include "client/operations/fetch.h"

namespace affskel::client {

/// Tells people and scripts what was written, and what to know of it.
void show_result(Console& console, const Fetched& fetched);

/// Tells people what was written.
void show_written(Console& console, const Fetched& fetched);

}  // namespace affskel::client
