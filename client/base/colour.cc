#include "client/base/colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace affskel::client {

Rgb viridis(float t) {
  // Samples of van der Walt and Smith's map at equal distances.
  static constexpr std::array<std::array<int, 3>, 10> kTable = {{{68, 1, 84},
                                                                 {72, 40, 120},
                                                                 {62, 74, 137},
                                                                 {49, 104, 142},
                                                                 {38, 130, 142},
                                                                 {31, 158, 137},
                                                                 {53, 183, 121},
                                                                 {110, 206, 88},
                                                                 {181, 222, 43},
                                                                 {253, 231, 37}}};
  const float place = std::clamp(t, 0.0f, 1.0f) * float(kTable.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), kTable.size() - 2);
  const auto colour = [](const std::array<int, 3>& c) {
    return Rgb{float(c[0]) / 255, float(c[1]) / 255, float(c[2]) / 255};
  };
  return mix(colour(kTable[low]), colour(kTable[low + 1]), place - float(low));
}

Rgb part_colour(std::uint32_t part) {
  static constexpr std::array<std::array<int, 3>, 9> kTable = {{{221, 204, 119},
                                                                {136, 204, 238},
                                                                {204, 102, 119},
                                                                {17, 119, 51},
                                                                {170, 68, 153},
                                                                {68, 170, 153},
                                                                {136, 34, 85},
                                                                {153, 153, 51},
                                                                {51, 34, 136}}};
  const auto& [r, g, b] = kTable[(part + kTable.size() - 1) % kTable.size()];
  return {float(r) / 255, float(g) / 255, float(b) / 255};
}

float colour_position(double erosion, double highest) {
  return highest > 0 ? static_cast<float>(std::cbrt(std::max(0.0, erosion) / highest)) : 0.0f;
}

}  // namespace affskel::client
