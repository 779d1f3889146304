#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace affskel::client {

/// What was probably meant by a word that is not known: the one of `known` with the least optimal string
/// alignment distance (letters added, left out, replaced, or two neighbours swapped), or one that it begins;
/// the first of several.  Leading dashes do not count.
/// @returns "" when none is within a third of the word's length.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

}  // namespace affskel::client
