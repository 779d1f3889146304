#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "base/pace.h"

namespace affskel::server {

/// How many calls that hold memory or open files a server has under way at once, how long it waits for their
/// peers, and how many connections it has.
struct CallLimits {
  std::size_t uploads = 512;    ///< meshes being received
  std::size_t downloads = 256;  ///< artefacts being sent; each has the database and its log open
  std::size_t waiting = 256;    ///< requests for artefacts that are yet to be made; half of them for one peer
  std::size_t watches = 4096;   ///< WatchJob streams
  std::size_t reports = 1024;   ///< reports being received
  std::size_t results = 256;    ///< results being received
  std::size_t inputs = 64;      ///< inputs of tasks being sent
  std::size_t polls = 1024;     ///< workers that wait for work
  std::size_t scrapes = 192;    ///< connections that ask for metrics or health

  std::uint64_t records_bytes = std::uint64_t{128} << 20;  ///< of reports, before they are merged
  std::uint64_t grpc_bytes = std::uint64_t{512} << 20;     ///< that gRPC may take for what is on its way

  std::chrono::milliseconds patience{5000};  ///< how long a download waits for its turn
  base::PaceOptions receiving;
  base::PaceOptions sending{.least_per_s = 8192};

  std::chrono::milliseconds idle{8000};  ///< a connection without calls is closed after this
  int streams = 1024;                    ///< calls of one connection at once
  std::size_t connections = 0;           ///< at once
};

/// What a process may have open, shared out: workers, the database and downloads keep descriptors that
/// connections cannot take.
/// @param open_files limit on descriptors, at least 1.
CallLimits limits_for(std::uint64_t open_files);

/// The limit on descriptors of this process.
std::uint64_t open_files_limit();

}  // namespace affskel::server
