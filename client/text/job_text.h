#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

/// The first 12 digits of the id, which `list` shows.
std::string short_id(const v1::Job& job);

/// The share that is done of its progress_of(), "41.3%": 100.0% only when all is.
std::string percent_text(const v1::Job& job);

/// `key: value` lines for `status`. @param colour states and warnings in ANSI colours.
std::string job_details(const v1::Job& job, bool colour = false);

/// Aligned columns for `list`, newest first as given. @param now_ms for the ages; @param colour states in
/// ANSI colours. @param width of the terminal, columns; 0 = none: a narrow one goes without columns, and then with
/// shorter names.
std::string job_table(const std::vector<v1::Job>& jobs, std::uint64_t now_ms, bool colour = false,
                      unsigned width = 0);

/// Reason of a FAILED job for people: "CODE: message (line N)".
std::string failure_text(const v1::JobError& error);

}  // namespace affskel::client
