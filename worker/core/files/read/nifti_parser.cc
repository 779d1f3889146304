// NIfTI-1, see nifti1.h of the NIfTI Data Format Working Group.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/coding.h"
#include "core/files/read/voxel_numbers.h"
#include "core/text/text_rows.h"

namespace affskel::core {
namespace {

constexpr std::size_t kNiftiHeader = 348;

class Nifti {
 public:
  explicit Nifti(std::string_view bytes) : bytes_(bytes) {
    big_ = base::decode<std::int32_t>(bytes.data()) != static_cast<std::int32_t>(kNiftiHeader);
  }

  VoxelImage run() const {
    if (bytes_.substr(344, 3) != "n+1")
      fail_at(0, std::string("has its numbers in another file") + kInOneFile);
    std::vector<double> sizes;
    for (int a = 1; a <= std::clamp<int>(number<std::int16_t>(40), 0, 7); ++a)
      sizes.push_back(number<std::int16_t>(40 + 2 * static_cast<std::size_t>(a)));
    VoxelImage image;
    image.size = sizes_of(sizes, 0);
    image.place = place();
    if (const float slope = number<float>(112); slope != 0 && std::isfinite(slope)) {
      image.scale = slope;
      image.offset = number<float>(116);
    }
    const float begin = number<float>(108);
    if (!(begin >= kNiftiHeader && begin <= static_cast<float>(bytes_.size())))
      fail_at(0, "its numbers begin behind the file's end");
    image.numbers =
        numbers_of(voxels_of(image.size), bytes_.substr(static_cast<std::size_t>(begin)), {}, kind(), big_);
    return image;
  }

 private:
  template <class Number>
  Number number(std::size_t at) const {
    return base::decode_ordered<Number>(bytes_.data() + at, big_);
  }
  double at(std::size_t place) const { return number<float>(place); }

  base::NumberKind kind() const {
    static const std::map<int, base::NumberKind> kTypes = {
        {2, base::kNumberKind<std::uint8_t>},    {4, base::kNumberKind<std::int16_t>},
        {8, base::kNumberKind<std::int32_t>},    {16, base::kNumberKind<float>},
        {64, base::kNumberKind<double>},         {256, base::kNumberKind<std::int8_t>},
        {512, base::kNumberKind<std::uint16_t>}, {768, base::kNumberKind<std::uint32_t>},
        {1024, base::kNumberKind<std::int64_t>}, {1280, base::kNumberKind<std::uint64_t>}};
    const auto found = kTypes.find(number<std::int16_t>(70));
    if (found == kTypes.end())
      fail_at(0, "type of values " + std::to_string(number<std::int16_t>(70)) + " is not read");
    return found->second;
  }

  // The affine form, else the rotation of a quaternion, else the spacings alone.
  AffineMap place() const {
    if (number<std::int16_t>(254) > 0) {
      AffineMap map;
      for (std::size_t row = 0; row < 3; ++row)
        map.rows[row] = {at(280 + 16 * row), at(284 + 16 * row), at(288 + 16 * row)};
      map.shift = {at(292), at(308), at(324)};
      return map;
    }
    const Vec3 s{at(80), at(84), at(88)};
    if (number<std::int16_t>(252) <= 0) return place_of({{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}, {0, 0, 0});
    const double b = at(256), c = at(260), d = at(264),
                 a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
    const double turn = at(76) < 0 ? -1 : 1;
    return place_of(
        {s.x * Vec3{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
         s.y * Vec3{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
         turn * s.z * Vec3{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b}},
        {at(268), at(272), at(276)});
  }

  std::string_view bytes_;
  bool big_ = false;
};

}  // namespace

bool is_nifti(std::string_view bytes) {
  return bytes.size() >= kNiftiHeader && (bytes.substr(344, 4) == std::string_view("n+1\0", 4) ||
                                          bytes.substr(344, 4) == std::string_view("ni1\0", 4));
}

VoxelImage parse_nifti(std::string_view bytes) {
  return Nifti(bytes).run();
}

}  // namespace affskel::core
