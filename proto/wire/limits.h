#pragma once

#include <cstddef>
#include <cstdint>

namespace affskel::wire {

/// Largest piece of bytes in one message of a stream.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// Largest number of field records in one message of a stream.
inline constexpr int kRecordsPerMessage = 32768;

/// Largest result of one task: what Protobuf can serialize.
inline constexpr std::uint64_t kMaxResultBytes = (std::uint64_t{1} << 31) - 1;

/// Bounds in one answer to a report: what gRPC's clients take unless told otherwise has room for the first,
/// for workers that say nothing; ours take up to the second.
inline constexpr std::uint32_t kUsualBoundsBytes = std::uint32_t{3} << 20;
inline constexpr std::uint32_t kMaxBoundsBytes = std::uint32_t{32} << 20;

/// Jobs in one answer to ListJobs.
inline constexpr std::uint32_t kMaxListedJobs = 1000;

}  // namespace affskel::wire
