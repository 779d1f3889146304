#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

/// `key: value` lines for `status`.
std::string job_details(const v1::Job& job);

/// Aligned columns for `list`, newest first as given. @param now_ms for the ages.
std::string job_table(const std::vector<v1::Job>& jobs, std::uint64_t now_ms);

/// Reason of a FAILED job for people: "CODE: message (line N)".
std::string failure_text(const v1::JobError& error);

}  // namespace affskel::client
