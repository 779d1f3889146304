#pragma once

#include "base/exit_code.h"
#include "process/console.h"
#include "process/options.h"

namespace affskel::server {

/// affskel-server token: beside a running server and without one.  The first token may be made before the
/// server's first start: the database is made then.  What they throw is what run_maintenance tells.

/// Prints the new token, alone on a line; with --json an object with its id, owner, role and expiry, too.
base::ExitCode add_token_command(const Options& options, const Console& console);

/// A table, or with --json one object a token in an array.
base::ExitCode list_tokens_command(const Options& options, const Console& console);

/// @throws StoreError kNotFound when there is no such token.
base::ExitCode revoke_token_command(const Options& options, const Console& console);

}  // namespace affskel::server
