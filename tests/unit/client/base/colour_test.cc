#include "client/base/colour.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace affskel::client {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;  // rows

Triple times(const Matrix& m, const Triple& v) {
  Triple result{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) result[r] += m[r][c] * v[c];
  return result;
}

// Linear light that people without, with protanopia, deuteranopia and tritanopia see alike: Machado, Oliveira and
// Fernandes, "A physiologically-based model for simulation of color vision deficiency", 2009.
constexpr std::array<Matrix, 4> kVisions{
    {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};

// CIELAB, white D65.
Triple lab(Rgb colour, const Matrix& vision) {
  Triple light;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto c = static_cast<double>(k == 0 ? colour.r : k == 1 ? colour.g : colour.b);
    light[k] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  light = times(vision, light);
  constexpr Matrix kToXyz{{{0.4339, 0.3762, 0.1899}, {0.2126, 0.7152, 0.0722}, {0.0178, 0.1095, 0.8727}}};
  Triple f = times(kToXyz, light);  // over the white's
  for (double& t : f) t = t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116;
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

TEST(PartColours, AreToldFromEachOtherByAnyEye) {
  const std::vector<Rgb> colours = part_colours({}, {}, kPartColours);
  ASSERT_GE(colours.size(), 24U) << "as many as pictures name";
  for (const Matrix& vision : kVisions) {
    for (std::size_t a = 0; a < colours.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const Triple p = lab(colours[a], vision), q = lab(colours[b], vision);
        EXPECT_GT(std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]), a < 12 ? 16 : 10.9)
            << a + 1 << " and " << b + 1;
      }
    }
  }
}

// A trunk that every third limb hangs on, the two after it on each other.
TEST(PartColours, OfPartsThatTouchDiffer) {
  constexpr std::uint32_t kParts = 60;
  std::vector<core::Triangle> surface;
  std::vector<std::uint32_t> part;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> touching;
  for (std::uint32_t p = 2; p <= kParts; ++p) {
    const std::uint32_t on = p % 3 == 1 ? 1 : p - 1;
    touching.push_back({on, p});
    const std::uint32_t first = 3 * p;
    surface.push_back({first, first + 1, first + 2});
    surface.push_back({first + 2, first + 1, 3 * kParts + 3 + p});
    part.insert(part.end(), {on, p});
  }
  const std::vector<Rgb> colours = part_colours(surface, part, kParts);
  ASSERT_EQ(colours.size(), kParts);
  for (const auto& [on, p] : touching) EXPECT_NE(colours[on - 1], colours[p - 1]) << p << " on " << on;
}

}  // namespace
}  // namespace affskel::client
