#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

namespace affskel::core {

/// Value of the erosion field at one point.
struct FieldValue {
  static constexpr std::uint32_t kNoDirection = 0xFFFFFFFFU;
  double erosion = std::numeric_limits<double>::infinity();  ///< E, volume; 36 significant bits, see sweep()
  double area = 0;                                           ///< of the section at the optimum
  std::uint32_t direction = kNoDirection;                    ///< the one that attains E

  /// Lexicographic order of (E, direction): the field's merge keeps the lesser.
  bool improves(const FieldValue& other) const {
    return erosion != other.erosion ? erosion < other.erosion : direction < other.direction;
  }
};

/// The E field while it is computed: per sample point the least (E, direction) offered so far, with its
/// area.  A semilattice (see README.md in worker/core): offers commute, repeat without effect and may come
/// from any thread.  Volumes and areas in scaled units of the solid.
///
/// Threads: offer(), bound(), erosion() and value() from any; take_changes() from any, too, each change going
/// to one.
class ErosionField {
 public:
  /// @param track_changes remember which points improved, for take_changes().
  ErosionField(std::uint32_t points, bool track_changes);

  std::uint32_t size() const { return static_cast<std::uint32_t>(erosion_.size()); }

  /// A recent value of E: never less than the present one.
  double erosion(std::uint32_t point) const {
    return std::atomic_ref<double>(const_cast<double&>(erosion_[point])).load(std::memory_order_relaxed);
  }

  /// Whether (erosion, direction) could improve the point; a quick test before offer().
  bool may_improve(std::uint32_t point, double erosion_value) const {
    return erosion_value <= erosion(point);
  }

  void offer(std::uint32_t point, const FieldValue& value);

  /// Lowers E at the point to `max_erosion`, if it is greater: another worker knows a direction that attains
  /// this.  The point then has kNoDirection, so that an equal chord still replaces the bound, and is no
  /// change for take_changes(): what was offered here cannot be E.
  void bound(std::uint32_t point, double max_erosion);

  /// A consistent copy of one value; without a direction after bound().
  FieldValue value(std::uint32_t point) const;

  /// Number of points that take_changes() would visit now.
  std::uint32_t changes() const;

  /// Calls `visit(point, value)` for every point of part `part` of `parts` of the field that improved since it was last
  /// visited, in ascending order, with a value that is at least as new as the improvement.
  template <class Visit>
  void take_changes(Visit visit, std::size_t part = 0, std::size_t parts = 1) {
    ChangedGroup taken;
    const std::size_t end = changed_.size() * (part + 1) / parts;
    for (std::size_t group = changed_.size() * part / parts; group < end; ++group) {
      if (std::atomic_ref<std::uint16_t>(changed_[group]).load(std::memory_order_relaxed) == 0) continue;
      take_group(static_cast<std::uint32_t>(group), taken);
      for (std::uint32_t n = 0; n < taken.count; ++n) visit(taken.point[n], taken.value[n]);
    }
  }

 private:
  // Side by side, since what is improved is rarely in the cache; packed for the memory.
  struct [[gnu::packed]] Optimum {
    double area = 0;
    std::uint32_t direction = FieldValue::kNoDirection;
  };
  static_assert(sizeof(Optimum) == 12);
  static constexpr std::size_t kLocks = 1024;
  // Held for a few stores only.  As many mutexes would push the field out of the first-level cache.
  class SpinLock {
   public:
    void lock() {
      while (flag_.test_and_set(std::memory_order_acquire)) {
        while (flag_.test(std::memory_order_relaxed)) std::this_thread::yield();
      }
    }
    void unlock() { flag_.clear(std::memory_order_release); }

   private:
    std::atomic_flag flag_;
  };

  // Consecutive points share a lock and a bit mask of changes.
  static constexpr std::uint32_t kGroup = 16;
  struct ChangedGroup {
    std::uint32_t count = 0;
    std::array<std::uint32_t, kGroup> point;
    std::array<FieldValue, kGroup> value;
  };

  FieldValue value_at(std::uint32_t point) const {
    return {erosion_[point], optimum_[point].area, optimum_[point].direction};
  }
  SpinLock& lock_of(std::uint32_t point) const { return locks_[point / kGroup % kLocks]; }

  void take_group(std::uint32_t group, ChangedGroup& taken);

  std::vector<double> erosion_;
  std::vector<Optimum> optimum_;
  std::vector<std::uint16_t> changed_;  // per group, a bit for each point; empty when not tracked
  mutable std::array<SpinLock, kLocks> locks_;
};

}  // namespace affskel::core
