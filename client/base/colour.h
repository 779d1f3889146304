#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::client {

/// Colour with components in 0 .. 1, as displayed (sRGB values, blended as they are).
struct Rgb {
  float r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

inline Rgb operator+(Rgb a, Rgb b) {
  return {a.r + b.r, a.g + b.g, a.b + b.b};
}
inline Rgb operator*(float s, Rgb a) {
  return {s * a.r, s * a.g, s * a.b};
}
/// a for t = 0, b for t = 1.
inline Rgb mix(Rgb a, Rgb b, float t) {
  return (1 - t) * a + t * b;
}

/// Perceptually uniform colours from dark violet (0) over green to yellow (1); t is clamped.
Rgb viridis(float t);

/// How many parts have a colour of their own.
inline constexpr std::uint32_t kPartColours = 24;

/// Colours of parts: the first kPartColours have one each, told from all others by people with any kind of colour
/// blindness, the first twelve most easily.  Further ones have one that none of the parts before them has which they
/// touch, as far as there is one.
/// @param triangle_part per triangle of the surface: from 1 to `parts`.
/// @return per part.
std::vector<Rgb> part_colours(std::span<const core::Triangle> surface,
                              std::span<const std::uint32_t> triangle_part, std::uint32_t parts);

/// Where E stands on the scale of colours, 0 .. 1.  E varies over orders of magnitude, like a volume: its
/// cube root is like a length.  @param highest E at 1.
float colour_position(double erosion, double highest);

}  // namespace affskel::client
