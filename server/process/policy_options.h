#pragma once

#include <string>
#include <vector>

#include "store/policy.h"

namespace affskel::server {

/// The options of a policy, as written.
struct PolicyWords {
  std::vector<std::string> limits;  ///< NAME=VALUE
  std::vector<std::string> quotas;  ///< [OWNER:]NAME=VALUE
  std::vector<std::string>
      retentions;  ///< [OWNER:]NAME=VALUE, and total-bytes=VALUE, grace=AGE without an owner
};

/// Reads a policy.  What is said of an owner replaces what is said of everyone, name by name, whichever comes
/// first.  Counts and bytes take the suffixes K, M, G and T (powers of 1024 for bytes, of 1000 for others),
/// ages s, h and d; 0 takes a limit away.
/// @throws std::invalid_argument that quotes the entry and says what is allowed.
Policy parse_policy(const PolicyWords& words);

}  // namespace affskel::server
