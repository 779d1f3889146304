#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace affskel::bench {

/// Runs `work` in a forked process and returns the string it returns.  Peak memory that the work reads
/// from getrusage() is then its own.  Call from a process with one thread.
/// @param memory_limit bytes of address space the process may use (RLIMIT_AS); 0: as many as this one.
/// @throws std::runtime_error with the cause when the work throws, when the process dies ("killed by
///   signal 9"), or when no process can be made.
std::string run_forked(const std::function<std::string()>& work, std::uint64_t memory_limit = 0);

}  // namespace affskel::bench
