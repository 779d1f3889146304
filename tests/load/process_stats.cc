#include "process_stats.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace affskel::load {

ProcessStats stats_of(pid_t pid) {
  const std::string directory = "/proc/" + std::to_string(pid);
  ProcessStats stats;
  std::ifstream status(directory + "/status");
  std::string word;
  while (status >> word) {
    if (word == "VmHWM:") status >> stats.peak_kib;
    if (word == "VmRSS:") status >> stats.resident_kib;
    if (word == "Threads:") status >> stats.threads;
  }
  std::error_code gone;
  const std::filesystem::directory_iterator descriptors(directory + "/fd", gone);
  if (!gone) stats.descriptors = std::distance(begin(descriptors), end(descriptors));
  return stats;
}

}  // namespace affskel::load
