#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

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

inline constexpr Rgb kWhite{1, 1, 1};

/// A picture, row by row from the top left.
class Image {
 public:
  Image(int width, int height, Rgb fill = kWhite)
      : width_(width), height_(height), pixels_(std::size_t(width) * std::size_t(height), fill) {}

  int width() const { return width_; }
  int height() const { return height_; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  Rgb& at(int x, int y) { return pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }
  const Rgb& at(int x, int y) const { return pixels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }

 private:
  int width_;
  int height_;
  std::vector<Rgb> pixels_;
};

/// The picture as the bytes of an 8-bit RGB PNG file.
/// @throws ClientError kInternal when libpng fails.
std::string encode_png(const Image& image);

/// Perceptually uniform colours from dark violet (0) over green to yellow (1); t is clamped.
Rgb viridis(float t);

}  // namespace affskel::client
