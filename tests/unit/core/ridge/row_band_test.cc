#include "core/ridge/row_band.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/collapse/lattice_solids.h"
#include "core/lattice/lattice_points.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

TEST(RowBand, IsTheHullOfWhatTheMarginsOfAllPointsReach) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.2);
    std::vector<std::uint8_t> margin;
    for (std::uint32_t p = 0; p < solid.lattice.points; ++p)
      margin.push_back(static_cast<std::uint8_t>(p * 7919 % 13 % 5));
    std::map<std::pair<std::int32_t, std::int32_t>, std::pair<std::int32_t, std::int32_t>> hull;
    for_each_point(solid.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      const std::int32_t m = margin[rank];
      for (std::int32_t a = i - m; a <= i + m; ++a) {
        for (std::int32_t b = j - m; b <= j + m; ++b) {
          auto& row = hull.try_emplace({a, b}, k - m, k + m + 1).first->second;
          row = {std::min(row.first, k - m), std::max(row.second, k + m + 1)};
        }
      }
    });
    const RowBand band(solid.lattice, margin);
    std::size_t places = 0;
    for (const auto& [at, row] : hull) {
      EXPECT_EQ(band.row(at.first, at.second).begin, row.first);
      EXPECT_EQ(band.row(at.first, at.second).end, row.second);
      EXPECT_EQ(band.at(at.first, at.second, row.first), static_cast<std::int64_t>(places));
      places += static_cast<std::size_t>(row.second - row.first);
    }
    EXPECT_EQ(band.places(), places) << "there are no others";
  }
}

}  // namespace
}  // namespace affskel::core
