#pragma once

#include <cstdint>

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

/// Colours that are told from each other, also by colour-blind people (the nine "muted" ones of Tol, "Colour schemes",
/// 2021), over again from the tenth on.  @param part from 1.
Rgb part_colour(std::uint32_t part);

/// Where E stands on the scale of colours, 0 .. 1.  E varies over orders of magnitude, like a volume: its
/// cube root is like a length.  @param highest E at 1.
float colour_position(double erosion, double highest);

}  // namespace affskel::client
