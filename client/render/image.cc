#include "client/render/image.h"

#include <png.h>

#include <algorithm>
#include <cmath>

#include "client/base/error.h"

namespace affskel::client {
namespace {

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

std::vector<std::uint8_t> to_bytes(const Image& image) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * std::size_t(image.width()) * std::size_t(image.height()));
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const Rgb& pixel = image.at(x, y);
      for (const float value : {pixel.r, pixel.g, pixel.b}) bytes.push_back(to_byte(value));
    }
  }
  return bytes;
}

}  // namespace

std::string encode_png(const Image& image) {
  const std::vector<std::uint8_t> pixels = to_bytes(image);
  png_image description{};
  description.version = PNG_IMAGE_VERSION;
  description.width = static_cast<png_uint_32>(image.width());
  description.height = static_cast<png_uint_32>(image.height());
  description.format = PNG_FORMAT_RGB;
  // More than it takes: how much exactly, libpng finds out by compressing it once more.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(description);
  std::string bytes(size, '\0');
  const int good = png_image_write_to_memory(&description, bytes.data(), &size, 0, pixels.data(), 0, nullptr);
  if (good == 0) throw ClientError(ExitCode::kInternal, std::string("libpng: ") + description.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace affskel::client
