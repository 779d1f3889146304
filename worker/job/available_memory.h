#pragma once

#include <cstdint>
#include <filesystem>

namespace affskel::worker {

/// How many bytes this process may still take before the kernel refuses or kills it: the least of
///   MemAvailable of /proc/meminfo;
///   limit minus use of its control group and of all groups above (versions 2 and 1; pages of files that were
///   not used lately do not count as used, the kernel gives them up);
///   the limit of the address space (ulimit -v) minus its size.
/// A look at one moment: others take memory, too, and swap is not counted.  At least 1; 0 when nothing is
/// known (no /proc).
/// @param root stands for the root of the file system.
std::uint64_t available_memory(const std::filesystem::path& root = "/");

}  // namespace affskel::worker
