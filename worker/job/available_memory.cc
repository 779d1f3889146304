#include "job/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

namespace affskel::worker {
namespace {

namespace fs = std::filesystem;
using Bytes = std::optional<std::uint64_t>;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

// The number after `name`, on the line of a file that begins with it; "max" and "unlimited" are no numbers.
Bytes number_after(const fs::path& file, const std::string& name) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(name)) continue;
    std::istringstream rest(line.substr(name.size()));
    std::uint64_t value = 0;
    if (rest >> value) return value;
    return std::nullopt;
  }
  return std::nullopt;
}

std::uint64_t left(std::uint64_t limit, std::uint64_t used) {
  return limit > used ? limit - used : 0;
}

std::uint64_t of_machine(const fs::path& root) {
  const Bytes kilobytes = number_after(root / "proc/meminfo", "MemAvailable:");
  return kilobytes ? *kilobytes * 1024 : kUnlimited;
}

// Limits are a soft one and a hard one, in bytes.
std::uint64_t of_address_space(const fs::path& root) {
  const Bytes limit = number_after(root / "proc/self/limits", "Max address space");
  const Bytes kilobytes = number_after(root / "proc/self/status", "VmSize:");
  return limit ? left(*limit, kilobytes.value_or(0) * 1024) : kUnlimited;
}

// The names of a version of control groups.
struct GroupFiles {
  const char *limit, *use, *unused_files;
};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", "inactive_file "};
constexpr GroupFiles kVersion1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "};

std::uint64_t of_group(const fs::path& group, const GroupFiles& files) {
  const Bytes limit = number_after(group / files.limit, ""), use = number_after(group / files.use, "");
  if (!limit || !use) return kUnlimited;
  const Bytes unused = number_after(group / "memory.stat", files.unused_files);
  return left(*limit, left(*use, unused.value_or(0)));
}

// Of a group and those above it, up to the mount.  A container may see its own group as the mount's root
// though it is named by its place on the host; places that are not there say nothing.
std::uint64_t of_groups(const fs::path& mount, fs::path name, const GroupFiles& files) {
  std::uint64_t least = of_group(mount, files);
  for (name = name.relative_path(); !name.empty(); name = name.parent_path()) {
    least = std::min(least, of_group(mount / name, files));
  }
  return least;
}

// Lines "hierarchy:controllers:name"; version 2 has hierarchy 0 and no controllers.
std::uint64_t of_control_groups(const fs::path& root) {
  std::ifstream lines(root / "proc/self/cgroup");
  std::uint64_t least = kUnlimited;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const fs::path name = line.substr(second + 1), mounts = root / "sys/fs/cgroup";
    if (line.starts_with("0::")) {
      least = std::min(least, of_groups(mounts, name, kVersion2));
    } else if (controllers.find(",memory,") != std::string::npos) {
      least = std::min(least, of_groups(mounts / "memory", name, kVersion1));
    }
  }
  return least;
}

}  // namespace

std::uint64_t available_memory(const fs::path& root) {
  const std::uint64_t least = std::min({of_machine(root), of_address_space(root), of_control_groups(root)});
  return least == kUnlimited ? 0 : std::max<std::uint64_t>(least, 1);
}

}  // namespace affskel::worker
