#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace affskel::core {

/// Properties of PLY's vertices by which MeshLab and Blender show E: made of E wherever that is written, and
/// left out where they are read beside it.
inline constexpr std::array<std::string_view, 4> kPlyDisplay = {"quality", "red", "green", "blue"};

/// Begins the comment that counts the faces which stand for curves, the last ones: a, b, b for an edge of a and b.
inline constexpr std::string_view kPlyCurves = "comment curves ";

inline bool is_ply_display(std::string_view name) {
  return std::find(kPlyDisplay.begin(), kPlyDisplay.end(), name) != kPlyDisplay.end();
}

}  // namespace affskel::core
