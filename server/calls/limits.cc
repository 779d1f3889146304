#include "calls/limits.h"

#include <sys/resource.h>

#include <algorithm>
#include <limits>

namespace affskel::server {
namespace {

// Of the descriptors, a quarter is never a connection's, up to this many: what downloads, workers' inputs,
// the log and the database need.
constexpr std::uint64_t kReserved = 1536;

// A connection over TLS costs some 75 kB, whatever the limit on descriptors is.
constexpr std::uint64_t kMaxConnections = 8192;

// The client's socket, and a pair between the relay and gRPC.
constexpr std::uint64_t kDescriptorsPerConnection = 3;

}  // namespace

CallLimits limits_for(std::uint64_t open_files) {
  CallLimits limits;
  const std::uint64_t reserve = std::min(kReserved, open_files / 4);
  limits.connections =
      std::clamp<std::uint64_t>((open_files - reserve) / kDescriptorsPerConnection, 1, kMaxConnections);
  // Two descriptors to a download or an input, one to a scrape: of what is left, an eighth stays at least.
  const std::uint64_t taken = kDescriptorsPerConnection * limits.connections;
  const std::uint64_t left = open_files > taken ? open_files - taken : 0;
  limits.downloads = std::clamp<std::uint64_t>(left / 4, 1, limits.downloads);
  limits.inputs = std::clamp<std::uint64_t>(left / 8, 1, limits.inputs);
  limits.scrapes = std::clamp<std::uint64_t>(left / 8, 1, limits.scrapes);
  return limits;
}

std::uint64_t open_files_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return std::numeric_limits<std::uint32_t>::max();
  }
  return std::max<std::uint64_t>(1, limit.rlim_cur);
}

}  // namespace affskel::server
