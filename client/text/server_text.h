#pragma once

#include <cstdint>
#include <string>

#include "affskel/v1/client_service.pb.h"

namespace affskel::client {

/// `key: value` lines for `server-info`.
std::string server_details(const v1::ServerInfo& info, std::uint64_t now_ms);

}  // namespace affskel::client
