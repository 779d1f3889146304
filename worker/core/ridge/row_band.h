#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/none.h"
#include "core/base/vec3.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// The places of a lattice that lie within a margin, so many steps along each axis, of a sample point, and what is
/// between them in a row: rows (i, j) of consecutive k.  Numbers the places, so that arrays over them hold a solid and
/// what lies round it without holding the lattice's whole box.
class RowBand {
 public:
  /// Places begin .. end - 1 of a row; the number of place k is offset + k.
  struct Row {
    std::int32_t begin = 0, end = 0;  ///< equal: the row has no places
    std::int64_t offset = 0;
    bool empty() const { return begin >= end; }
    void include(const Row& other) {
      begin = empty() ? other.begin : std::min(begin, other.begin);
      end = std::max(end, other.end);
    }
  };

  /// Not in the band.
  static constexpr std::int64_t kNone = -1;

  RowBand(const Lattice& lattice, std::uint8_t margin);

  /// @param margin per sample point.
  RowBand(const Lattice& lattice, std::span<const std::uint8_t> margin);

  std::size_t places() const { return places_; }

  /// i and j may lie outside the band: an empty row.
  const Row& row(std::int32_t i, std::int32_t j) const {
    static constexpr Row kNoRow;
    if (i < -margin_ || j < -margin_ || i >= ends_[0] || j >= ends_[1]) return kNoRow;
    return rows_[index(i, j)];
  }

  /// The number of a place, 0 .. places() - 1, or kNone.
  std::int64_t at(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const Row& r = row(i, j);
    return k >= r.begin && k < r.end ? r.offset + k : kNone;
  }

  /// Whether is_wanted(number, square of its distance) accepts a place of the band within `reach` steps, along
  /// each axis, of real indices; asks in lattice order until it does.
  template <class IsWanted>
  bool any_near(const Vec3& at, double reach, const IsWanted& is_wanted) const {
    const auto first = [&](int axis) { return static_cast<std::int32_t>(std::ceil(at[axis] - reach)); };
    const auto last = [&](int axis) { return static_cast<std::int32_t>(std::floor(at[axis] + reach)); };
    for (std::int32_t i = first(0); i <= last(0); ++i) {
      for (std::int32_t j = first(1); j <= last(1); ++j) {
        for (std::int32_t k = first(2); k <= last(2); ++k) {
          const std::int64_t number = this->at(i, j, k);
          const Vec3 way = at - Vec3{double(i), double(j), double(k)};
          if (number != kNone && is_wanted(static_cast<std::size_t>(number), dot(way, way))) return true;
        }
      }
    }
    return false;
  }

 private:
  std::size_t index(std::int32_t i, std::int32_t j) const {
    return static_cast<std::size_t>(i + margin_) * static_cast<std::size_t>(ends_[1] + margin_) +
           static_cast<std::size_t>(j + margin_);
  }

  template <class MarginOf>
  RowBand(const Lattice& lattice, std::int32_t widest, const MarginOf& margin_of);

  void widen_by_one();
  void number_places();

  std::int32_t margin_;
  std::int32_t ends_[2];
  std::vector<Row> rows_;
  std::size_t places_ = 0;
};

/// Per place of a band: the rank of the sample point there, or kNone.
std::vector<std::uint32_t> ranks_in(const RowBand& band, const Lattice& lattice);

/// The sample points near a place.
class NearPoints {
 public:
  explicit NearPoints(const Lattice& lattice) : band_(lattice, 0), rank_(ranks_in(band_, lattice)) {}

  /// As RowBand::any_near(), is_wanted(rank, square of its distance).
  template <class IsWanted>
  bool any_near(const Vec3& at, double reach, const IsWanted& is_wanted) const {
    return band_.any_near(at, reach, [&](std::size_t place, double square) {
      return rank_[place] != affskel::core::kNone && is_wanted(rank_[place], square);
    });
  }

 private:
  RowBand band_;
  std::vector<std::uint32_t> rank_;  // per place of the band
};

}  // namespace affskel::core
