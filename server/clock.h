#pragma once

#include <cstdint>

namespace affskel::server {

/// Time as the store sees it; tests inject their own.  Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;

  /// Unix milliseconds, for people.
  virtual std::int64_t wall_ms() const = 0;

  /// Milliseconds for lease deadlines: Unix time at the start of the process plus monotonic time since,
  /// so that neither a corrected wall clock nor a suspended machine expires leases at one stroke.
  virtual std::int64_t lease_ms() const = 0;
};

/// The clocks of this machine.
class SystemClock final : public Clock {
 public:
  SystemClock();
  std::int64_t wall_ms() const override;
  std::int64_t lease_ms() const override;

 private:
  std::int64_t offset_ms_;
};

}  // namespace affskel::server
