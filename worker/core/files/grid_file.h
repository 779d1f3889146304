#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace affskel::core {

/// How a grid's file stores the numbers of an array.
enum class GridType { kFloat64, kInt32, kUint8 };

/// An array over all places of a grid.
struct GridArray {
  std::string name;
  GridType type = GridType::kFloat64;
  std::size_t components = 1;
  std::size_t first = 0;  ///< its first component's place among the components of all arrays
};

/// The values of some consecutive planes of constant i of a grid.
class GridPlanes {
 public:
  /// @param blank values of places that get none, one per component.
  GridPlanes(const std::array<std::uint32_t, 3>& dims, std::vector<double> blank)
      : dims_(dims), blank_(std::move(blank)) {}

  std::uint32_t begin() const { return first_; }
  std::uint32_t end() const { return first_ + static_cast<std::uint32_t>(planes_.size()); }

  /// Holds plane i, too, and all before it that are not held yet.
  void hold(std::uint32_t i) {
    while (end() <= i) {
      std::vector<double>& plane = planes_.emplace_back();
      plane.reserve(blank_.size() * plane_size());
      for (const double value : blank_) plane.insert(plane.end(), plane_size(), value);
    }
  }
  /// Forgets the planes before i.
  void drop(std::uint32_t i) {
    for (; first_ < i; ++first_) planes_.pop_front();
  }

  double& at(std::size_t component, std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return planes_[i - first_][component * plane_size() + std::size_t{j} * dims_[2] + k];
  }
  double at(std::size_t component, std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return planes_[i - first_][component * plane_size() + std::size_t{j} * dims_[2] + k];
  }

 private:
  std::size_t plane_size() const { return std::size_t{dims_[1]} * dims_[2]; }

  std::array<std::uint32_t, 3> dims_;
  std::vector<double> blank_;
  std::uint32_t first_ = 0;
  std::deque<std::vector<double>> planes_;
};

/// Calls `take` with the values of an array in planes [begin, end), in the order of VTK: components of a
/// place together, i fastest, k slowest.
template <typename Take>
void for_each_value(const GridArray& array, const std::array<std::uint32_t, 3>& dims,
                    const GridPlanes& planes, std::uint32_t begin, std::uint32_t end, Take take) {
  for (std::uint32_t k = 0; k < dims[2]; ++k) {
    for (std::uint32_t j = 0; j < dims[1]; ++j) {
      for (std::uint32_t i = begin; i < end; ++i) {
        for (std::size_t c = 0; c < array.components; ++c) take(planes.at(array.first + c, i, j, k));
      }
    }
  }
}

/// A file that holds arrays over a grid and is written some planes at a time.
class GridFile {
 public:
  virtual ~GridFile() = default;
  /// How many planes it takes at a time, >= 1, and how many of them it wants again with the next.
  virtual std::uint32_t planes_at_a_time() const = 0;
  virtual std::uint32_t overlap() const = 0;
  /// The planes [begin, end), all of which are held.
  virtual void write(const GridPlanes& planes, std::uint32_t begin, std::uint32_t end) = 0;
  /// Call once, last.  The file is left uncommitted.
  virtual void finish() = 0;
};

}  // namespace affskel::core
