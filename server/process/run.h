#pragma once

#include "process/options.h"

namespace affskel::server {

/// Runs a server with its workers until a signal or idleness ends it.  Returns the exit code.
int run(const Options& options);

}  // namespace affskel::server
