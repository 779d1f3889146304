#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "base/exit_code.h"

namespace affskel::client {

/// What the exit codes mean, for the help and the manual.
inline constexpr auto kExitCodes = [] {
  std::array<std::pair<int, std::string_view>, base::kExitCodes.size()> codes;
  for (std::size_t i = 0; i < codes.size(); ++i)
    codes[i] = {static_cast<int>(base::kExitCodes[i].code), base::kExitCodes[i].meaning};
  return codes;
}();

}  // namespace affskel::client
