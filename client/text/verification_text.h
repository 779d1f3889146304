#pragma once

#include <string>

#include "affskel/v1/client_service.pb.h"

namespace affskel::client {

/// `key: value` lines for `verify`: what was compared in all, then each worker that gave something.
std::string verification_details(const v1::Verification& verification);

/// The first sample in which two workers differ; null when there is none.
const v1::VerifiedSample* first_differing(const v1::Verification& verification);

/// Which worker gave what another did not get.
std::string difference_text(const v1::VerifiedSample& sample);

/// What could not be computed again; "" when all was.
std::string gap_text(const v1::Verification& verification);

}  // namespace affskel::client
