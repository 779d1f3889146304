#include "core/height_order.h"

#include <algorithm>
#include <array>

namespace affskel::core {
namespace {

// Adding 1.5 * 2^8 leaves 44 bits behind the point of a double; taking it away again rounds to them.
constexpr double kRounder = 384.0;
// The tilt that breaks ties; any vector in no special position will do.
constexpr Vec3 kTilt{0.5497787143782138, 0.7853981633974483, 0.2861788337373061};
// Up to this many vertices comparing is quicker than clearing counters, and up to that many four passes
// over 8 bits are quicker than three over 11.
constexpr std::size_t kFewVertices = 48;
constexpr std::size_t kManyVertices = 3000;

}  // namespace

HeightOrder::HeightOrder(const std::vector<Vec3>& points)
    : rounded_(points.size()),
      entries_(points.size()),
      buffer_(points.size()),
      order_(points.size()),
      rank_(points.size()),
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
  compute_keys(d);
  sort_entries();
  settle_equal_keys();
  for (std::size_t r = 0; r < entries_.size(); ++r) {
    const std::uint32_t v = entries_[r].vertex;
    order_[r] = v;
    rank_[v] = static_cast<std::uint32_t>(r);
    height_[r] = rounded_[v];
  }
}

void HeightOrder::compute_keys(const Vec3& d) {
  const std::size_t count = rounded_.size();
  double low = 2, high = -2;
  for (std::size_t v = 0; v < count; ++v) {
    const double h = (d.x * x_[v] + d.y * y_[v]) + d.z * z_[v];
    const double rounded = (h + kRounder) - kRounder;
    rounded_[v] = rounded;
    low = std::min(low, rounded);
    high = std::max(high, rounded);
  }
  const double scale = high > low ? 4294967040.0 / (high - low) : 0;
  for (std::size_t v = 0; v < count; ++v) {
    entries_[v] = {static_cast<std::uint32_t>(static_cast<std::int64_t>((rounded_[v] - low) * scale)),
                   static_cast<std::uint32_t>(v)};
  }
}

bool HeightOrder::below(std::uint32_t a, std::uint32_t b) const {
  if (rounded_[a] != rounded_[b]) return rounded_[a] < rounded_[b];
  return tilt_[a] != tilt_[b] ? tilt_[a] < tilt_[b] : a < b;
}

void HeightOrder::sort_entries() {
  if (entries_.size() < kFewVertices) {
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return a.key != b.key ? a.key < b.key : a.vertex < b.vertex;
    });
    return;
  }
  if (entries_.size() < kManyVertices) {
    radix_sort<8>();
  } else {
    radix_sort<11>();
  }
}

template <int bits>
void HeightOrder::radix_sort() {
  for (int shift = 0; shift < 32; shift += bits) {
    radix_pass<bits>(shift, entries_, buffer_);
    entries_.swap(buffer_);
  }
}

template <int bits>
void HeightOrder::radix_pass(int shift, const std::vector<Entry>& from, std::vector<Entry>& to) {
  constexpr std::size_t kDigits = std::size_t{1} << bits;
  std::array<std::uint32_t, kDigits> place{};
  for (const Entry& e : from) ++place[(e.key >> shift) & (kDigits - 1)];
  std::uint32_t sum = 0;
  for (std::uint32_t& p : place) {
    const std::uint32_t count = p;
    p = sum;
    sum += count;
  }
  for (const Entry& e : from) to[place[(e.key >> shift) & (kDigits - 1)]++] = e;
}

// Keys hold the first 32 bits of the heights; what they leave equal is compared in full.
void HeightOrder::settle_equal_keys() {
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
