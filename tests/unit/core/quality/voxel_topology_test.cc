#include "core/quality/voxel_topology.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>

namespace affskel::core {
namespace {

using Places = std::vector<LatticePlace>;

// The voxels of a block of `side`^3 that `keep`, moved by `by`, in lattice order.
template <class Keep>
Places block(std::uint32_t side, Keep keep, std::uint32_t by = 0) {
  Places voxels;
  for (std::uint32_t i = 0; i < side; ++i) {
    for (std::uint32_t j = 0; j < side; ++j) {
      for (std::uint32_t k = 0; k < side; ++k) {
        if (keep(i, j, k)) voxels.push_back({i + by, j + by, k + by});
      }
    }
  }
  return voxels;
}

using Cell = std::array<int, 3>;

// Floods the cells of a set (26- or 6-neighbours); the number of floods.
std::uint64_t floods(std::set<Cell> cells, bool across_corners) {
  std::uint64_t count = 0;
  while (!cells.empty()) {
    ++count;
    std::vector<Cell> queue{*cells.begin()};
    cells.erase(cells.begin());
    while (!queue.empty()) {
      const Cell at = queue.back();
      queue.pop_back();
      for (int n = 0; n < 27; ++n) {
        const Cell step{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
        if (!across_corners && std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]) != 1) continue;
        const Cell next{at[0] + step[0], at[1] + step[1], at[2] + step[2]};
        if (cells.erase(next) != 0) queue.push_back(next);
      }
    }
  }
  return count;
}

// By the book: floods, and all cells of the cubical complex in doubled coordinates.
BettiNumbers brute_force(const Places& voxels, int side) {
  std::set<Cell> inside, outside, complex;
  for (const LatticePlace& v : voxels) {
    inside.insert({static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2])});
  }
  for (int i = -1; i <= side; ++i) {
    for (int j = -1; j <= side; ++j) {
      for (int k = -1; k <= side; ++k) {
        if (!inside.contains({i, j, k})) outside.insert({i, j, k});
      }
    }
  }
  for (const Cell& c : inside) {
    for (int n = 0; n < 27; ++n) {
      complex.insert({2 * c[0] + n / 9 - 1, 2 * c[1] + n / 3 % 3 - 1, 2 * c[2] + n % 3 - 1});
    }
  }
  std::int64_t euler = 0;  // a cell's dimension is the number of its even coordinates
  for (const Cell& c : complex) {
    const int dimension = 3 - (std::abs(c[0]) % 2 + std::abs(c[1]) % 2 + std::abs(c[2]) % 2);
    euler += dimension % 2 == 0 ? 1 : -1;
  }
  BettiNumbers numbers{floods(inside, true), 0, floods(outside, false) - 1};
  numbers.holes =
      static_cast<std::uint64_t>(static_cast<std::int64_t>(numbers.components + numbers.cavities) - euler);
  return numbers;
}

TEST(VoxelBettiNumbers, OfSimpleSets) {
  EXPECT_EQ(voxel_betti_numbers({}), (BettiNumbers{0, 0, 0}));
  EXPECT_EQ(voxel_betti_numbers(Places{{4, 7, 9}}), (BettiNumbers{1, 0, 0}));
  // Joined at a corner; apart by one voxel.
  EXPECT_EQ(voxel_betti_numbers(Places{{0, 0, 0}, {1, 1, 1}}), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(voxel_betti_numbers(Places{{0, 0, 0}, {2, 1, 1}}), (BettiNumbers{2, 0, 0}));
  EXPECT_EQ(voxel_betti_numbers(Places{{0, 0, 0}, {0, 0, 2}}), (BettiNumbers{2, 0, 0}));
}

TEST(VoxelBettiNumbers, OfRingsInEveryPose) {
  const auto rim = [](std::uint32_t a, std::uint32_t b) { return a == 0 || a == 4 || b == 0 || b == 4; };
  const BettiNumbers ring{1, 1, 0};
  EXPECT_EQ(voxel_betti_numbers(block(5, [&](auto i, auto j, auto k) { return k == 2 && rim(i, j); })), ring);
  EXPECT_EQ(voxel_betti_numbers(block(5, [&](auto i, auto j, auto k) { return j == 2 && rim(i, k); })), ring);
  EXPECT_EQ(voxel_betti_numbers(block(5, [&](auto i, auto j, auto k) { return i == 2 && rim(j, k); })), ring);
}

TEST(VoxelBettiNumbers, OfAHollowBlockAndItsFrame) {
  const auto outer = [](std::uint32_t a) { return a == 0 || a == 4; };
  EXPECT_EQ(voxel_betti_numbers(block(
                5, [&](auto i, auto j, auto k) { return outer(i) || outer(j) || outer(k); }, 3)),
            (BettiNumbers{1, 0, 1}));
  // The 12 edges of a cube: 8 vertices, 12 edges, so 5 loops.
  EXPECT_EQ(voxel_betti_numbers(
                block(5, [&](auto i, auto j, auto k) { return outer(i) + outer(j) + outer(k) >= 2; })),
            (BettiNumbers{1, 5, 0}));
}

TEST(VoxelBettiNumbers, AgreeWithACountOfAllCells) {
  std::mt19937_64 random(11);
  for (const int percent : {8, 20, 35, 50, 65, 80, 92}) {
    for (int trial = 0; trial < 6; ++trial) {
      std::uniform_int_distribution<int> draw(0, 99);
      const Places voxels = block(7, [&](auto, auto, auto) { return draw(random) < percent; });
      EXPECT_EQ(voxel_betti_numbers(voxels), brute_force(voxels, 7)) << percent << " % trial " << trial;
    }
  }
}

}  // namespace
}  // namespace affskel::core
