#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "affskel/v1/client_service.pb.h"

namespace affskel::client {

/// "queued", "running", "done", "failed", "cancelled"; "unknown" for anything else.
std::string state_word(v1::JobState state);
/// "prepare", "erode", "derive", "complete"; "unknown" for anything else.
std::string stage_word(v1::JobStage stage);
/// "axis", "pca", "obb" or "affine".
std::string frame_word(v1::Frame frame);

/// `key: value` lines for `status`.
std::string job_details(const v1::Job& job);

/// Aligned columns for `list`, newest first as given. @param now_ms for the ages.
std::string job_table(const std::vector<v1::Job>& jobs, std::uint64_t now_ms);

/// `key: value` lines for `server-info`.
std::string server_details(const v1::ServerInfo& info, std::uint64_t now_ms);

/// One `key: value` line with the values in one column.
std::string key_line(const std::string& key, const std::string& value);

/// UTC time as 2026-01-31 12:34:56.789Z; "-" for 0.
std::string utc_time(std::uint64_t unix_ms);
/// "0.4 s", "12 s", "3 min 05 s", "2 h 07 min", "5 d 03 h".
std::string duration_text(std::chrono::milliseconds duration);

/// Now, as Unix milliseconds.
std::uint64_t unix_now_ms();

/// Reason of a FAILED job for people: "CODE: message (line N)".
std::string failure_text(const v1::JobError& error);

}  // namespace affskel::client
