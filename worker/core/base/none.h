#pragma once

#include <cstdint>

namespace affskel::core {

/// No point, triangle, edge, node ...: in place of the number of one.
inline constexpr std::uint32_t kNone = 0xFFFFFFFFU;

}  // namespace affskel::core
