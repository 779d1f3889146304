#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>

#include "access/identity.h"

namespace affskel::server {

/// The maker of a call.
struct Caller {
  std::uint64_t connection = 0;   ///< its number
  std::string peer;               ///< whose connection it is: shares are counted by this
  std::optional<uid_t> uid = {};  ///< of its process, on a Unix socket
  bool has_certificate = false;   ///< it has shown one over TLS, and it is good
  Identity identity = {};         ///< as the gate has found
};

}  // namespace affskel::server
