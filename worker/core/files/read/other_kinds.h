#pragma once

#include <string_view>

namespace affskel::core {

/// The first word that is in no comment (#); a byte order mark is passed over.
std::string_view first_word(std::string_view bytes);

/// Refuses files that are known by their first bytes and cannot be read, with what they are and what to do.
/// @throws CoreError kBadInput.
void refuse_other_kinds(std::string_view bytes);

/// Refuses what neither its content nor its name tells to be of a kind that is read, unless it may be OFF text.
/// @throws CoreError kBadInput with the kinds.
void refuse_unknown_kinds(std::string_view bytes);

}  // namespace affskel::core
