#pragma once

#include "core/base/error.h"

namespace affskel::core {

/// Checks an option: @throws CoreError kBadInput with the message unless low <= value <= high; NaN never is.
inline void require_within(double value, double low, double high, const char* message) {
  if (!(value >= low && value <= high)) refuse(message);
}

}  // namespace affskel::core
