#pragma once

#include <string_view>

namespace affskel::client {

/// What stands at the scale of colours, in pictures and on pages; see colour_position.
inline constexpr std::string_view kScaleTitle = "Erosion level E, % of v0";
inline constexpr std::string_view kScaleNote = "Not linear: the colour follows the cube root of E";

}  // namespace affskel::client
