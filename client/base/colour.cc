#include "client/base/colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>

namespace affskel::client {
namespace {

// Of 8-bit colours in steps of 17, not too dark, light or glaring, ten beside Tol's sand and cyan ("Colour schemes",
// 2021) whose least difference (CIEDE2000) as seen without and with protanopia, deuteranopia and tritanopia (Machado,
// Oliveira and Fernandes 2009) a local search made greatest: 14.8; then twelve, chosen so beside these: 9.2 among
// all.  The lighter ones of each twelve first, for the largest parts, the last apart.
constexpr std::array<std::array<int, 3>, kPartColours> kPartTable = {
    {{221, 204, 119}, {136, 204, 238}, {221, 119, 170}, {153, 136, 0},   {153, 102, 238}, {136, 170, 136},
     {102, 119, 119}, {170, 17, 0},    {119, 51, 187},  {119, 68, 68},   {51, 85, 102},   {204, 221, 204},
     {255, 204, 34},  {170, 204, 204}, {187, 170, 0},   {170, 153, 255}, {0, 170, 85},    {85, 136, 102},
     {204, 68, 170},  {119, 119, 51},  {17, 119, 136},  {68, 51, 119},   {119, 17, 68},   {85, 255, 255}}};

// Per part, from 0: those before it that have a vertex in common with it.
std::vector<std::set<std::uint32_t>> lower_neighbours(std::span<const core::Triangle> surface,
                                                      std::span<const std::uint32_t> triangle_part,
                                                      std::uint32_t parts) {
  std::vector<std::vector<std::uint32_t>> at_vertex;
  for (std::size_t t = 0; t < surface.size(); ++t) {
    for (const std::uint32_t v : surface[t]) {
      if (v >= at_vertex.size()) at_vertex.resize(v + std::size_t{1});
      at_vertex[v].push_back(triangle_part[t] - 1);
    }
  }
  std::vector<std::set<std::uint32_t>> lower(parts);
  for (const auto& round : at_vertex)
    for (const std::uint32_t a : round)
      for (const std::uint32_t b : round)
        if (b < a) lower[a].insert(b);
  return lower;
}

}  // namespace

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

std::vector<Rgb> part_colours(std::span<const core::Triangle> surface,
                              std::span<const std::uint32_t> triangle_part, std::uint32_t parts) {
  const std::vector<std::set<std::uint32_t>> lower = lower_neighbours(surface, triangle_part, parts);
  std::vector<std::uint32_t> number(parts);
  std::vector<Rgb> colours;
  for (std::uint32_t part = 0; part < parts; ++part) {
    std::array<bool, kPartColours> taken{};
    for (const std::uint32_t other : lower[part]) taken[number[other]] = part >= kPartColours;
    number[part] = part % kPartColours;
    for (std::uint32_t n = 0; n < kPartColours && taken[number[part]]; ++n)
      number[part] = (number[part] + 1) % kPartColours;
    const auto& [r, g, b] = kPartTable[number[part]];
    colours.push_back({float(r) / 255, float(g) / 255, float(b) / 255});
  }
  return colours;
}

float colour_position(double erosion, double highest) {
  return highest > 0 ? static_cast<float>(std::cbrt(std::max(0.0, erosion) / highest)) : 0.0f;
}

}  // namespace affskel::client
