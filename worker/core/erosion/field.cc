#include "core/erosion/field.h"

#include <bit>
#include <mutex>

namespace affskel::core {
namespace {

using Mask = std::atomic_ref<std::uint16_t>;

}  // namespace

ErosionField::ErosionField(std::uint32_t points, bool track_changes)
    : erosion_(points, std::numeric_limits<double>::infinity()),
      optimum_(points),
      changed_(track_changes ? points / kGroup + 1 : 0, 0) {}

void ErosionField::offer(std::uint32_t point, const FieldValue& offered) {
  const std::lock_guard<SpinLock> guard(lock_of(point));
  if (!offered.improves(value_at(point))) return;
  std::atomic_ref<double>(erosion_[point]).store(offered.erosion, std::memory_order_relaxed);
  optimum_[point] = {offered.area, offered.direction};
  if (changed_.empty()) return;
  // Only ever written under the lock; take_changes() looks at it without.
  const Mask mask(changed_[point / kGroup]);
  const auto bit = static_cast<std::uint16_t>(1U << (point % kGroup));
  mask.store(mask.load(std::memory_order_relaxed) | bit, std::memory_order_relaxed);
}

void ErosionField::bound(std::uint32_t point, double max_erosion) {
  if (!(max_erosion < erosion(point))) return;
  const std::lock_guard<SpinLock> guard(lock_of(point));
  if (!(max_erosion < erosion_[point])) return;
  std::atomic_ref<double>(erosion_[point]).store(max_erosion, std::memory_order_relaxed);
  optimum_[point] = {};
  if (changed_.empty()) return;
  const Mask mask(changed_[point / kGroup]);
  const auto bit = static_cast<std::uint16_t>(1U << (point % kGroup));
  mask.store(mask.load(std::memory_order_relaxed) & static_cast<std::uint16_t>(~bit),
             std::memory_order_relaxed);
}

FieldValue ErosionField::value(std::uint32_t point) const {
  const std::lock_guard<SpinLock> guard(lock_of(point));
  return value_at(point);
}

std::uint32_t ErosionField::changes() const {
  std::uint32_t count = 0;
  for (const std::uint16_t& group : changed_) {
    const std::uint16_t mask = Mask(const_cast<std::uint16_t&>(group)).load(std::memory_order_relaxed);
    count += static_cast<std::uint32_t>(std::popcount(mask));
  }
  return count;
}

void ErosionField::take_group(std::uint32_t group, ChangedGroup& taken) {
  taken.count = 0;
  const std::lock_guard<SpinLock> guard(lock_of(group * kGroup));
  const Mask mask(changed_[group]);
  for (unsigned bits = mask.load(std::memory_order_relaxed); bits != 0; bits &= bits - 1) {
    const std::uint32_t point = group * kGroup + static_cast<std::uint32_t>(std::countr_zero(bits));
    taken.point[taken.count] = point;
    taken.value[taken.count++] = value_at(point);
  }
  mask.store(0, std::memory_order_relaxed);
}

}  // namespace affskel::core
