#include "client/view/view_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace affskel::client {
namespace {

// One run per line: a full box of points.
v1::Lattice full_lattice(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
  v1::Lattice lattice;
  for (const double v : {1.0, 2.0, 3.0}) lattice.add_origin(v);
  for (const double v : {0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.5}) lattice.add_axes(v);
  for (const std::uint32_t d : {nx, ny, nz}) lattice.add_dims(d);
  for (std::uint32_t line = 0; line < nx * ny; ++line) {
    lattice.add_run_start(std::uint64_t{line} * nz);
    lattice.add_run_length(nz);
  }
  return lattice;
}

TEST(ViewPoints, RoundingKeepsEveryComparisonWithAFloat) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const float bound = static_cast<float>(random() % 1000) / 64;
    // Around the bound, nearer to it than neighbouring floats are to each other.
    const double value = bound * (1 + 1e-8 * (static_cast<double>(random() % 201) - 100));
    EXPECT_EQ(view_divergence(value) > bound, value > double{bound}) << value;
    EXPECT_EQ(view_divergence(-value) > bound, value > double{bound}) << value;
    EXPECT_EQ(view_share(value, 1) >= bound, value >= double{bound}) << value;
  }
}

TEST(ViewPoints, TheSliderReachesDownToATenthOfItsThreshold) {
  const std::vector<float> divergences(1000, 1.0f);
  const ViewSelection selection = select_view_points(divergences, 7, 1000);
  EXPECT_NEAR(selection.lowest_threshold, 0.7, 1e-6);
  EXPECT_LE(double{selection.lowest_threshold}, 0.7);
}

TEST(ViewPoints, TheSkeletonIsHeldWhole) {
  const std::vector<float> divergences(8000, 9.0f);  // ten times as many as there is room for
  const ViewSelection selection = select_view_points(divergences, 7.3, 800);
  EXPECT_LE(double{selection.lowest_threshold}, 7.3);
  EXPECT_NEAR(selection.lowest_threshold, 7.3, 1e-6);
}

TEST(ViewPoints, NoMoreAreHeldThanThereIsRoomFor) {
  std::vector<float> divergences;
  for (int p = 0; p < 10000; ++p) divergences.push_back(static_cast<float>(p) / 1000);  // 0 .. 9.999
  const ViewSelection selection = select_view_points(divergences, 9.5, 2000);
  EXPECT_EQ(std::count_if(divergences.begin(), divergences.end(),
                          [&](float h) { return h > selection.lowest_threshold; }),
            2000);
}

TEST(ViewPoints, AGridOfFewStepsIsTheLattice) {
  const LatticePoints lattice(full_lattice(3, 4, 5));
  const ViewGrid grid = view_grid(lattice);
  EXPECT_EQ(grid.lattice_steps, (std::array<std::uint32_t, 3>{1, 1, 1}));
  EXPECT_EQ(grid.axes[1].y, 0.5);
  EXPECT_EQ(grid.origin.z, 3.0);
}

TEST(ViewPoints, ALongAxisIsCoarsenedToSixteenBits) {
  const LatticePoints lattice(full_lattice(1, 1, 150000));
  const ViewGrid grid = view_grid(lattice);
  EXPECT_EQ(grid.lattice_steps[2], 3u);
  EXPECT_EQ(grid.axes[2].z, 1.5);
  const ViewSelection all;
  const std::vector<float> one = {1};
  std::vector<ViewPoint> points;
  ViewPointCollector collector(grid, all, one, 1, points);
  FieldPoint last;
  last.k = 149999;
  collector.put(last);
  EXPECT_EQ(points.at(0).step[2], 49999);
}

TEST(ViewPoints, AboveTheLowestThresholdAreSortedByDivergenceThenByPlace) {
  const LatticePoints lattice(full_lattice(1, 1, 5));
  const ViewGrid grid = view_grid(lattice);
  const ViewSelection above_one{1};
  const std::vector<float> divergences = {2, 7, 2, 9, 1};
  std::vector<ViewPoint> points;
  ViewPointCollector collector(grid, above_one, divergences, 10, points);
  for (std::uint32_t k = 0; k < 5; ++k) {
    FieldPoint point;
    point.k = k;
    point.erosion = k;
    point.slope = 10 * k;
    collector.put(point);
  }
  collector.finish();
  std::vector<int> places;
  for (const ViewPoint& point : points) places.push_back(point.step[2]);
  EXPECT_EQ(places, (std::vector<int>{3, 1, 0, 2}));
  EXPECT_EQ(points[1].slope, 10);
  EXPECT_EQ(points[1].share, 0.1f > 0.1 ? std::nextafter(0.1f, 0.0f) : 0.1f);
}

}  // namespace
}  // namespace affskel::client
