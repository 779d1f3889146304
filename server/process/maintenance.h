#pragma once

#include "process/options.h"

namespace affskel::server {

/// Runs check, backup, migrate, trust or a command on tokens, as options.command says.  What came of it goes to
/// stdout as "key: value" lines or as one JSON document, faults and errors to stderr.  Returns the exit code.
int run_maintenance(const Options& options);

}  // namespace affskel::server
