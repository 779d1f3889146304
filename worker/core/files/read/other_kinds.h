#pragma once

#include <string_view>

namespace affskel::core {

/// Refuses files that are known by their first bytes and cannot be read, with what they are and what to do.
/// @throws CoreError kBadInput.
void refuse_other_kinds(std::string_view bytes);

}  // namespace affskel::core
