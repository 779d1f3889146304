#pragma once

#include <atomic>
#include <cstdint>

namespace affskel::chaos {

/// What a process under test is made to suffer.  The driver writes it, the preloaded library reads it; both
/// map the same file, whose path the process finds in `$AFFSKEL_CHAOS_CONTROL`.
struct Control {
  /// Added to what CLOCK_REALTIME says, in nanoseconds.
  std::atomic<std::int64_t> clock_shift_ns;
  /// Bits of `Trouble`: what calls on regular files answer.
  std::atomic<std::uint32_t> trouble;
  /// How many calls were made to fail, or read a shifted clock, since the driver last set it to 0.
  std::atomic<std::uint32_t> bites;
};

static_assert(std::atomic<std::int64_t>::is_always_lock_free);

enum Trouble : std::uint32_t {
  kNoTrouble = 0,
  kNoSpace = 1U << 0,      ///< ENOSPC where a file would grow or be written, and no free bytes
  kWriteError = 1U << 1,   ///< EIO from writing
  kSyncError = 1U << 2,    ///< EIO from fsync and fdatasync
  kReadError = 1U << 3,    ///< EIO from reading
  kReadOnly = 1U << 4,     ///< EROFS from whatever changes the file system
  kShortWrites = 1U << 5,  ///< half of what was to be written is
};

}  // namespace affskel::chaos
