#pragma once

namespace affskel::server {

/// What affskel-server tells its caller: the client's codes, as far as they apply.
enum class ExitCode : int {
  kDone = 0,
  kFaults = 1,      ///< check: the database is not sound
  kUsage = 2,       ///< also an address or data directory that a server cannot use
  kBadInput = 3,    ///< of a command: no database of ours, or a file that cannot be read or written
  kNotFound = 4,    ///< no such token
  kCancelled = 6,   ///< interrupted
  kNotAllowed = 7,  ///< a server runs, or a file is there already
  kLimit = 8,       ///< disk full
  kInternal = 70,
};

}  // namespace affskel::server
