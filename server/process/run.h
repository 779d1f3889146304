#pragma once

#include "process/options.h"

namespace affskel::server {

/// Runs what the command line asks for: a server with its workers, until a signal or idleness ends it, or a
/// command on a data directory.  Returns the exit code.
int run(const Options& options);

}  // namespace affskel::server
