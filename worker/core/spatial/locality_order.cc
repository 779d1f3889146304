#include "core/spatial/locality_order.h"

#include <algorithm>
#include <utility>

#include "core/mesh/box.h"

namespace affskel::core {
namespace {

constexpr double kMaxCell = (1 << 21) - 1;  // of a cell's number along an axis

// Bit i to bit 3 i, of 21 bits.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001F00000000FFFF;
  bits = (bits | bits << 16) & 0x001F0000FF0000FF;
  bits = (bits | bits << 8) & 0x100F00F00F00F00F;
  bits = (bits | bits << 4) & 0x10C30C30C30C30C3;
  bits = (bits | bits << 2) & 0x1249249249249249;
  return bits;
}

std::uint64_t spread_cell(double x, double low, double scale) {
  return spread(static_cast<std::uint64_t>(std::clamp((x - low) * scale, 0.0, kMaxCell)));
}

}  // namespace

std::vector<std::uint32_t> locality_order(const std::vector<Vec3>& points) {
  const Box box = box_of(points);
  const double side = box.longest_side();
  const double scale = side > 0 ? kMaxCell / side : 0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> places;
  places.reserve(points.size());
  for (const Vec3& p : points) {
    places.emplace_back(spread_cell(p.x, box.low.x, scale) | spread_cell(p.y, box.low.y, scale) << 1 |
                            spread_cell(p.z, box.low.z, scale) << 2,
                        static_cast<std::uint32_t>(places.size()));
  }
  std::sort(places.begin(), places.end());
  std::vector<std::uint32_t> order;
  order.reserve(points.size());
  for (const auto& [cell, index] : places) order.push_back(index);
  return order;
}

}  // namespace affskel::core
