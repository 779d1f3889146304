#pragma once

namespace affskel::core {

/// Changes whenever a field could differ in any bit from the last version's; part of every cache key.
inline constexpr const char* kCoreVersion = "12";

}  // namespace affskel::core
