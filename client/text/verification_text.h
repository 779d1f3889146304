#pragma once

#include <string>

#include "affskel/v1/client_service.pb.h"

namespace affskel::client {

/// `key: value` lines for `verify`: what was compared in all, then each worker that gave something.
std::string verification_details(const v1::Verification& verification);

/// Which workers gave what others did not get, and what to do; "" when there is no difference.
std::string difference_text(const v1::Verification& verification);

/// What could not be computed again; "" when all was.
std::string gap_text(const v1::Verification& verification);

}  // namespace affskel::client
