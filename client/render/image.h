#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "client/base/colour.h"

namespace affskel::client {

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

}  // namespace affskel::client
