#pragma once

#include <string>
#include <vector>

#include "wire/address.h"

namespace affskel::server {

/// Checks the addresses before anything is bound: only local ones (others need TLS, which this version
/// does not have), sockets whose directory exists and that no live server answers on; stale sockets are
/// removed.
/// @throws std::runtime_error naming the address and the cause.
void prepare_addresses(const std::vector<wire::Address>& addresses);

}  // namespace affskel::server
