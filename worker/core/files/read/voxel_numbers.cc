#include "core/files/read/voxel_numbers.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/coding.h"
#include "core/base/error.h"
#include "core/files/read/shape_parsers.h"

namespace affskel::core {
namespace {

constexpr std::size_t kMaxVoxels = std::size_t{1} << 30;

std::size_t bytes_of(Scalar scalar) {
  switch (scalar) {
    case Scalar::kInt8:
    case Scalar::kUint8:
      return 1;
    case Scalar::kInt16:
    case Scalar::kUint16:
      return 2;
    case Scalar::kInt32:
    case Scalar::kUint32:
    case Scalar::kFloat:
      return 4;
    case Scalar::kInt64:
    case Scalar::kUint64:
    case Scalar::kDouble:
      return 8;
  }
  return 0;
}

template <class Number>
void decode_all(std::string_view bytes, bool swapped, std::vector<float>& values) {
  std::array<char, sizeof(Number)> raw;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::copy_n(bytes.data() + i * sizeof(Number), sizeof(Number), raw.begin());
    if (swapped) std::reverse(raw.begin(), raw.end());
    values[i] = static_cast<float>(base::decode<Number>(raw.data()));
  }
}

}  // namespace

std::size_t voxels_of(const std::array<std::size_t, 3>& size) {
  std::size_t count = 1;
  for (const std::size_t n : size) {
    if (n == 0) fail_at(0, "an axis of the image has no voxels");
    if (n > kMaxVoxels / count)
      throw CoreError(CoreError::Code::kLimit,
                      "the image has more than " + std::to_string(kMaxVoxels) + " voxels");
    count *= n;
  }
  return count;
}

void take_numbers(std::string_view bytes, const Numbers& numbers, VoxelImage& image) {
  const std::size_t count = voxels_of(image.size);
  if (bytes.size() / bytes_of(numbers.scalar) < count) {
    fail_at(0, std::to_string(count) + " voxels announced, but only " + std::to_string(bytes.size()) +
                   " bytes follow");
  }
  image.values.resize(count);
  const bool swapped = numbers.big_endian;
  switch (numbers.scalar) {
    case Scalar::kInt8:
      decode_all<std::int8_t>(bytes, swapped, image.values);
      break;
    case Scalar::kUint8:
      decode_all<std::uint8_t>(bytes, swapped, image.values);
      break;
    case Scalar::kInt16:
      decode_all<std::int16_t>(bytes, swapped, image.values);
      break;
    case Scalar::kUint16:
      decode_all<std::uint16_t>(bytes, swapped, image.values);
      break;
    case Scalar::kInt32:
      decode_all<std::int32_t>(bytes, swapped, image.values);
      break;
    case Scalar::kUint32:
      decode_all<std::uint32_t>(bytes, swapped, image.values);
      break;
    case Scalar::kInt64:
      decode_all<std::int64_t>(bytes, swapped, image.values);
      break;
    case Scalar::kUint64:
      decode_all<std::uint64_t>(bytes, swapped, image.values);
      break;
    case Scalar::kFloat:
      decode_all<float>(bytes, swapped, image.values);
      break;
    case Scalar::kDouble:
      decode_all<double>(bytes, swapped, image.values);
      break;
  }
  if (numbers.scale != 1 || numbers.offset != 0)
    for (float& value : image.values)
      value = static_cast<float>(numbers.scale * double{value} + numbers.offset);
}

std::array<std::size_t, 3> sizes_of(const std::vector<double>& numbers, std::uint64_t line) {
  std::array<std::size_t, 3> size{};
  if (numbers.size() < 3) fail_at(line, "the image has " + std::to_string(numbers.size()) + " axes, needs 3");
  for (std::size_t a = 0; a < numbers.size(); ++a) {
    const double n = numbers[a];
    if (!(n >= 1) || n != std::floor(n) || n > static_cast<double>(kMaxVoxels))
      fail_at(line, "the size of an axis must be a whole number from 1 on");
    if (a < 3) size[a] = static_cast<std::size_t>(n);
    if (a >= 3 && n != 1)
      fail_at(line, "the image has more than one value at a place, or more than three axes");
  }
  return size;
}

AffineMap place_of(const std::vector<Vec3>& steps, const Vec3& origin) {
  AffineMap map;
  map.rows = {Vec3{steps[0].x, steps[1].x, steps[2].x}, Vec3{steps[0].y, steps[1].y, steps[2].y},
              Vec3{steps[0].z, steps[1].z, steps[2].z}};
  map.shift = origin;
  return map;
}

}  // namespace affskel::core
