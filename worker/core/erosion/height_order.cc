#include "core/erosion/height_order.h"

#include <algorithm>
#include <array>
#include <utility>

namespace affskel::core {
namespace {

// Adding 1.5 * 2^8 leaves 44 bits behind the point of a double; taking it away again rounds to them.
constexpr double kRounder = 384.0;
// The tilt that breaks ties; any vector in no special position will do.
constexpr Vec3 kTilt{0.5497787143782138, 0.7853981633974483, 0.2861788337373061};
// With fewer vertices, two or three digits of 8 bits leave so few equal keys that ordering these costs less
// than one digit more, or than counters for digits of 11 bits.
constexpr std::size_t kTwoDigitVertices = 500;
constexpr std::size_t kThreeDigitVertices = 3000;

}  // namespace

HeightOrder::HeightOrder(const std::vector<Vec3>& points)
    : rounded_(points.size()),
      entries_(points.size()),
      buffer_(points.size()),
      order_(points.size()),
      height_(points.size()) {
  x_.reserve(points.size());
  y_.reserve(points.size());
  z_.reserve(points.size());
  tilt_.reserve(points.size());
  for (const Vec3& p : points) {
    x_.push_back(p.x);
    y_.push_back(p.y);
    z_.push_back(p.z);
    tilt_.push_back((kTilt.x * p.x + kTilt.y * p.y) + kTilt.z * p.z);
  }
}

void HeightOrder::sort(const Vec3& d) {
  const std::size_t vertices = entries_.size();
  const int key_bits = vertices < kTwoDigitVertices ? 16 : vertices < kThreeDigitVertices ? 24 : 32;
  compute_keys(d, key_bits);
  if (vertices < kTwoDigitVertices) {
    radix_sort<8, 2>();
  } else if (vertices < kThreeDigitVertices) {
    radix_sort<8, 3>();
  } else {
    radix_sort<11, 3>();
  }
  resolve_ties();
  for (std::size_t r = 0; r < vertices; ++r) {
    order_[r] = entries_[r].vertex;
    height_[r] = rounded_[entries_[r].vertex];
  }
}

void HeightOrder::compute_keys(const Vec3& d, int key_bits) {
  const std::size_t count = rounded_.size();
  double low = 2, high = -2;
  for (std::size_t v = 0; v < count; ++v) {
    const double h = (d.x * x_[v] + d.y * y_[v]) + d.z * z_[v];
    const double rounded = (h + kRounder) - kRounder;
    rounded_[v] = rounded;
    low = std::min(low, rounded);
    high = std::max(high, rounded);
  }
  const double largest = static_cast<double>((std::uint64_t{1} << key_bits) - 1);
  const double scale = high > low ? largest / (high - low) : 0;
  for (std::size_t v = 0; v < count; ++v) {
    const double key = std::min((rounded_[v] - low) * scale, largest);
    entries_[v] = {static_cast<std::uint32_t>(static_cast<std::int64_t>(key)), static_cast<std::uint32_t>(v)};
  }
}

bool HeightOrder::below(std::uint32_t a, std::uint32_t b) const {
  if (rounded_[a] != rounded_[b]) return rounded_[a] < rounded_[b];
  return tilt_[a] != tilt_[b] ? tilt_[a] < tilt_[b] : a < b;
}

template <int bits, int passes>
void HeightOrder::radix_sort() {
  constexpr std::size_t kDigits = std::size_t{1} << bits;
  const auto digit = [](const Entry& e, std::size_t pass) {
    return (e.key >> (bits * pass)) & (kDigits - 1);
  };
  std::array<std::array<std::uint32_t, kDigits>, passes> place{};
  for (const Entry& e : entries_) {
    for (std::size_t pass = 0; pass < passes; ++pass) ++place[pass][digit(e, pass)];
  }
  for (std::size_t pass = 0; pass < passes; ++pass) {
    std::uint32_t sum = 0;
    for (std::uint32_t& p : place[pass]) sum += std::exchange(p, sum);
    for (const Entry& e : entries_) buffer_[place[pass][digit(e, pass)]++] = e;
    entries_.swap(buffer_);
  }
}

// Keys hold the first bits of the heights; what they leave equal is compared in full.
void HeightOrder::resolve_ties() {
  const auto full = [this](const Entry& a, const Entry& b) { return below(a.vertex, b.vertex); };
  for (std::size_t first = 0; first < entries_.size();) {
    std::size_t last = first + 1;
    while (last < entries_.size() && entries_[last].key == entries_[first].key) ++last;
    if (last - first > 1) {
      std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(first),
                entries_.begin() + static_cast<std::ptrdiff_t>(last), full);
    }
    first = last;
  }
}

}  // namespace affskel::core
