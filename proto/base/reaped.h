#pragma once

#include <sys/types.h>

#include <future>
#include <optional>

namespace affskel::base {

/// The status of a child, as waitpid() tells it, once that has ended; nothing where the system has reaped it, as it does
/// if SIGCHLD is ignored.  A thread of its own waits for it: whoever lives longer than his child keeps no zombie of it,
/// though he never asks for the status.
/// @throws std::system_error when there can be no thread.
std::future<std::optional<int>> reaped(pid_t child);

}  // namespace affskel::base
