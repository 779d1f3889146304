#pragma once

#include <cstdint>
#include <string>

#include "affskel/v1/client_service.pb.h"

namespace affskel::server {

/// The maker of a call.
struct Identity {
  std::string owner;  ///< of the caller's own jobs; empty: of none in particular (see Gate)
  v1::Role role = v1::ROLE_UNSPECIFIED;
  std::int64_t token = 0;  ///< the id of the token that said so; 0 = none
};

}  // namespace affskel::server
