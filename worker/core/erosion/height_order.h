#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

/// Sorts the vertices of a mesh by height d.y, direction after direction.
///
/// Heights are rounded to multiples of kUnit (coordinates are at most 1/2), so that the vertices of a level
/// face tie although their products round differently.  Ties are broken by height along a fixed tilt, then by
/// index: so a level face has one lowest vertex, and no false minima.
class HeightOrder {
 public:
  static constexpr double kUnit = 0x1p-44;

  explicit HeightOrder(const std::vector<Vec3>& points);

  /// Fills order and height for unit vector d.  O(V).
  void sort(const Vec3& d);

  const std::vector<std::uint32_t>& order() const { return order_; }  ///< vertex, by rank
  const std::vector<double>& height() const { return height_; }       ///< rounded height, by rank

 private:
  struct Entry {
    std::uint32_t key;
    std::uint32_t vertex;
  };

  void compute_keys(const Vec3& d, int key_bits);
  template <int bits, int passes>
  void radix_sort();
  void resolve_ties();
  bool below(std::uint32_t a, std::uint32_t b) const;

  std::vector<double> x_, y_, z_;
  std::vector<double> tilt_;             // by vertex: height along the tilt
  std::vector<double> rounded_;          // by vertex
  std::vector<Entry> entries_, buffer_;  // key: height scaled to so many bits
  std::vector<std::uint32_t> order_;
  std::vector<double> height_;
};

}  // namespace affskel::core
