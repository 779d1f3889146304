#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace affskel::tests {

/// The most memory that this process has had, bytes; what sanitizers take is among it.
inline std::uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  std::uint64_t kib = 0;
  while (status >> word)
    if (word == "VmHWM:") status >> kib;
  return kib << 10;
}

}  // namespace affskel::tests
