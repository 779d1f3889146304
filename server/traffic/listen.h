#pragma once

#include <vector>

#include "wire/address.h"

namespace affskel::server {

/// How TCP callers are known.
struct Protection {
  bool tls = false;
  bool tokens = false;    ///< there is one that a caller could show
  bool insecure = false;  ///< the administrator wants none of it
};

/// Checks the addresses before anything is bound: sockets whose directory exists and that no live server
/// answers on; stale sockets are removed.
/// @throws std::runtime_error naming the address and the cause.
void prepare_addresses(const std::vector<wire::Address>& addresses);

/// Refuses addresses that other machines reach, unless TLS and tokens protect them or the protection is not
/// wanted.
/// @throws std::runtime_error naming the address and what is missing.
void require_protection(const std::vector<wire::Address>& addresses, const Protection& protection);

}  // namespace affskel::server
