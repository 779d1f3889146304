#include "core/field.h"

#include <algorithm>
#include <bit>

namespace affskel::core {
namespace {

// Sorts different numbers below `limit`.
void sort_points(std::vector<std::uint32_t>& points, std::uint32_t limit) {
  if (points.size() < limit / 64) {
    std::sort(points.begin(), points.end());
    return;
  }
  std::vector<std::uint64_t> present(limit / 64 + 1, 0);
  for (std::uint32_t p : points) present[p / 64] |= std::uint64_t{1} << (p % 64);
  auto to = points.begin();
  for (std::uint32_t word = 0; word < present.size(); ++word) {
    for (std::uint64_t bits = present[word]; bits != 0; bits &= bits - 1) {
      *to++ = 64 * word + static_cast<std::uint32_t>(std::countr_zero(bits));
    }
  }
}

}  // namespace

ErosionField::ErosionField(std::uint32_t points, bool track_changes)
    : erosion_(points, std::numeric_limits<double>::infinity()),
      area_(points, 0),
      direction_(points, FieldValue::kNoDirection),
      changed_(track_changes ? points : 0, 0) {}

void ErosionField::offer(std::uint32_t point, const FieldValue& offered) {
  const std::lock_guard<SpinLock> guard(lock_of(point));
  if (!offered.improves({erosion_[point], area_[point], direction_[point]})) return;
  std::atomic_ref<double>(erosion_[point]).store(offered.erosion, std::memory_order_relaxed);
  area_[point] = offered.area;
  direction_[point] = offered.direction;
  if (changed_.empty() || changed_[point] != 0) return;
  // Listed before the point is let go: whoever improves it next relies on finding it listed.
  changed_[point] = 1;
  const std::lock_guard<std::mutex> list_guard(changes_mutex_);
  changes_.push_back(point);
}

FieldValue ErosionField::value(std::uint32_t point) const {
  const std::lock_guard<SpinLock> guard(lock_of(point));
  return {erosion_[point], area_[point], direction_[point]};
}

std::vector<std::uint32_t> ErosionField::take_changes() {
  std::vector<std::uint32_t> taken;
  {
    const std::lock_guard<std::mutex> guard(changes_mutex_);
    taken.swap(changes_);
  }
  sort_points(taken, size());
  // A point that improves again from here on is listed again; its value read later is at least as new.
  for (std::uint32_t point : taken) {
    const std::lock_guard<SpinLock> guard(lock_of(point));
    changed_[point] = 0;
  }
  return taken;
}

}  // namespace affskel::core
