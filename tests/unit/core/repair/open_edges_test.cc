#include "core/repair/open_edges.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/stopping_context.h"

namespace affskel::core {
namespace {

// Triangles in the plane x = 0, in rows that are parted by their size.
std::vector<Triangle> in_one_plane(std::uint32_t count, std::vector<Vec3>& points) {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 at{0, 2.0 * (i % 100), 2.0 * (i / 100)};
    for (const Vec3& way : {Vec3{}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) points.push_back(at + way);
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return triangles;
}

// Work is counted by how often the context is asked: every pair of ends would be some 30,000 times.
TEST(JoinNearPoints, LooksAtNearEndsAloneHoweverTheyLie) {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles = in_one_plane(20000, points);
  StoppingContext never;
  EXPECT_EQ(join_near_points(points, triangles, &never), 0U);
  EXPECT_LT(never.asked(), 1000U);
  expect_stops_wherever_it_is_asked(20, [&](ExecutionContext* context) {
    std::vector<Triangle> same = triangles;
    join_near_points(points, same, context);
  });
}

TEST(JoinNearPoints, JoinsWhatRoundingHasParted) {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles = in_one_plane(100, points);
  const auto first = static_cast<std::uint32_t>(points.size());
  // Beside the first one, its long side parted by less than a millionth of the diagonal.
  for (const Vec3& p : {Vec3{1e-5, 1, 1e-5}, Vec3{0, 1, 1}, Vec3{0, -1e-5, 1}}) points.push_back(p);
  triangles.push_back({first, first + 1, first + 2});
  EXPECT_EQ(join_near_points(points, triangles), 2U);
  EXPECT_EQ(triangles.back(), (Triangle{1, first + 1, 2}));
}

}  // namespace
}  // namespace affskel::core
