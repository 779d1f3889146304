#include "core/files/read/voxel_numbers.h"

#include <cmath>

#include "core/base/error.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

constexpr std::size_t kMaxVoxels = std::size_t{1} << 30;

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

base::PackedNumbers numbers_of(std::size_t voxels, std::string_view seen, std::optional<std::string> own,
                               const base::NumberKind& kind, bool big_endian) {
  const std::size_t given = own ? own->size() : seen.size();
  if (given / kind.bytes < voxels)
    fail_at(
        0, std::to_string(voxels) + " voxels announced, but only " + std::to_string(given) + " bytes follow");
  if (own) return {std::move(*own), kind, big_endian};
  return {seen, kind, big_endian};
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

std::string read_numbers_beside(const std::string& name, std::uint64_t line, const ReadBeside& beside) {
  if (!beside) fail_at(line, std::string("has its numbers in another file") + kInOneFile);
  if (name.empty() || name == "." || name == ".." || name.find_first_of("/\\") != std::string::npos)
    fail_at(line, "has its numbers in '" + name.substr(0, 60) +
                      "', which is not in the same folder; put it there, and let the header name it alone");
  if (name.starts_with("LIST") || name.find('%') != std::string::npos)
    fail_at(line, std::string("has its numbers in several files") + kInOneFile);
  return beside(name);
}

AffineMap place_of(const std::vector<Vec3>& steps, const Vec3& origin) {
  return {{Vec3{steps[0].x, steps[1].x, steps[2].x}, Vec3{steps[0].y, steps[1].y, steps[2].y},
           Vec3{steps[0].z, steps[1].z, steps[2].z}},
          origin};
}

}  // namespace affskel::core
