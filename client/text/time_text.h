#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace affskel::client {

/// UTC time as 2026-01-31 12:34:56.789Z; "-" for 0.
std::string utc_time(std::uint64_t unix_ms);
/// "0.4 s", "12 s", "3 min 05 s", "2 h 07 min", "5 d 03 h".
std::string duration_text(std::chrono::milliseconds duration);

/// A time as it was measured: with milliseconds below a minute, above as duration_text.
std::string took_text(std::chrono::milliseconds duration);

/// Now, as Unix milliseconds.
std::uint64_t unix_now_ms();

/// The time between two Unix times in milliseconds, as duration_text; 0 when they are out of order.
std::string age_text(std::uint64_t then_ms, std::uint64_t now_ms);

}  // namespace affskel::client
