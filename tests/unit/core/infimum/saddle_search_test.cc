// Against all vertices, one after another, and lower links counted in another way.
#include "core/infimum/saddle_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/base/unit.h"
#include "core/infimum/piece_input.h"
#include "core/infimum/samples.h"
#include "core/shapes/body.h"

namespace affskel::core {
namespace {

// How many connected sets the neighbours below form, by edges between them that triangles at the vertex have.
std::size_t parts_below(const Mesh& mesh, std::uint32_t vertex, const Vec3& x, const Vec3& d) {
  std::vector<std::set<std::uint32_t>> parts;
  const auto below = [&](std::uint32_t v) { return dot(d, mesh.points[v] - x) < 0; };
  for (const Triangle& t : mesh.triangles) {
    if (std::find(t.begin(), t.end(), vertex) == t.end()) continue;
    std::set<std::uint32_t> part;
    for (const std::uint32_t v : t) {
      if (v != vertex && below(v)) part.insert(v);
    }
    if (part.empty()) continue;
    for (auto other = parts.begin(); other != parts.end();) {
      const bool meets =
          std::any_of(part.begin(), part.end(), [&](std::uint32_t v) { return other->count(v) != 0; });
      if (meets) part.insert(other->begin(), other->end());
      other = meets ? parts.erase(other) : other + 1;
    }
    parts.push_back(part);
  }
  return parts.size();
}

class SaddleSearchTest : public testing::Test {
 protected:
  SaddleSearchTest() : solid_(make_solid(make_body({.triangles = 500}))), input_(solid_), search_(input_) {}

  Solid solid_;
  PieceInput input_;
  SaddleSearch search_;
  SplitMix64 random_{3};
};

TEST_F(SaddleSearchTest, SinkingOnes) {
  std::size_t total = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3 x = 0.1 * draw_vector(random_);
    const Vec3 d = draw_direction(random_);
    const Vec3 end = d + 0.2 * draw_vector(random_);
    const std::vector<SaddleSearch::Saddle> found = search_.sinking(x, d, end, {});
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    std::set<std::uint32_t> vertices;
    for (const SaddleSearch::Saddle& saddle : found) {
      vertices.insert(saddle.vertex);
      const Vec3 touching = d + saddle.at * (end - d);
      EXPECT_NEAR(dot(touching, input_.mesh.points[saddle.vertex] - x), 0, 1e-12);
    }
    for (std::uint32_t v = 0; v < input_.mesh.points.size(); ++v) {
      const Vec3 y = input_.mesh.points[v] - x;
      const bool sinks = dot(d, y) >= 0 && dot(end, y) < 0;
      const double at = dot(d, y) / (dot(d, y) - dot(end, y));
      const bool saddle = sinks && parts_below(input_.mesh, v, x, d + at * (end - d)) >= 2;
      EXPECT_EQ(vertices.count(v) != 0, saddle) << v;
    }
    total += vertices.size();
    if (found.empty()) continue;
    const std::vector<std::uint32_t> but = {found.front().vertex};
    EXPECT_EQ(search_.sinking(x, d, end, but).size() + 1, vertices.size());
  }
  EXPECT_GT(total, 60U);
}

TEST_F(SaddleSearchTest, OnesJustBelow) {
  std::size_t total = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3 x = 0.1 * draw_vector(random_);
    const Vec3 d = draw_direction(random_);
    std::set<std::uint32_t> vertices;
    for (const SaddleSearch::Saddle& saddle : search_.just_below(x, d)) vertices.insert(saddle.vertex);
    for (std::uint32_t v = 0; v < input_.mesh.points.size(); ++v) {
      const Vec3 y = input_.mesh.points[v] - x;
      const double sine = -dot(d, y) / norm(y);
      const bool near = sine > 0 && sine <= 0.1;  // the mesh is small
      const bool saddle = near && parts_below(input_.mesh, v, x, d + (sine / norm(y)) * y) >= 2;
      EXPECT_EQ(vertices.count(v) != 0, saddle) << v;
    }
    total += vertices.size();
  }
  EXPECT_GT(total, 60U);
}

// In any order of questions: what the search remembers of the last one changes nothing.
TEST_F(SaddleSearchTest, NearestOnes) {
  for (int n = 0; n < 300; ++n) {
    const Vec3 x = 0.6 * draw_vector(random_);
    std::vector<SaddleSearch::Saddle> all;
    for (const PieceInput::Saddle& saddle : input_.saddles) {
      const Vec3 y = input_.mesh.points[saddle.vertex] - x;
      all.push_back({dot(y, y), saddle.vertex});
    }
    std::sort(all.begin(), all.end());
    const std::size_t count = n % 10 == 9 ? all.size() + 5 : static_cast<std::size_t>(n % 9);
    const std::vector<SaddleSearch::Saddle>& found = search_.nearest(x, count);
    ASSERT_EQ(found.size(), std::min(count, all.size()));
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].vertex, all[i].vertex);
  }
}

TEST_F(SaddleSearchTest, OnesThatPlanesNearOneTouch) {
  std::size_t meet = 0;
  for (int n = 0; n < 40; ++n) {
    const Vec3 x = 0.2 * draw_vector(random_), d = draw_direction(random_);
    const double sine = 0.1 + 0.015 * n;
    std::set<std::uint32_t> found;
    for (const PieceInput::Saddle* saddle : search_.in_reach(x, d, sine)) {
      EXPECT_TRUE(found.insert(saddle->vertex).second);
      const Vec3 y = input_.mesh.points[saddle->vertex] - x;
      EXPECT_LE(std::abs(dot(d, y)), (sine + 1e-12) * norm(y));
    }
    EXPECT_LT(found.size(), input_.saddles.size());
    for (int k = 0; k < 2000; ++k) {
      const auto vertex = static_cast<std::uint32_t>(static_cast<std::size_t>(k) % input_.mesh.points.size());
      const Vec3 y = unit(input_.mesh.points[vertex] - x), near = d + sine * draw_vector(random_);
      const Vec3 touching = unit(near - dot(near, y) * y);
      if (norm(cross(d, touching)) > sine || dot(d, touching) < 0) continue;
      if (parts_below(input_.mesh, vertex, input_.mesh.points[vertex], touching) < 2) continue;
      EXPECT_EQ(found.count(vertex), 1U);
      ++meet;
    }
  }
  EXPECT_GT(meet, 100U);
}

TEST_F(SaddleSearchTest, PartsMayMeetWhereTheyDo) {
  std::size_t meet = 0;
  for (int n = 0; n < 3000; ++n) {
    const auto vertex = static_cast<std::uint32_t>(static_cast<std::size_t>(n) % input_.mesh.points.size());
    const Vec3& s = input_.mesh.points[vertex];
    const Vec3 d = draw_direction(random_), y = draw_vector(random_);
    const Vec3 x = s + 0.3 * (y - dot(d, y) * d);  // of a plane that touches the vertex
    if (parts_below(input_.mesh, vertex, s, d) < 2) continue;
    const auto saddle = std::ranges::find(input_.saddles, vertex, &PieceInput::Saddle::vertex);
    ASSERT_NE(saddle, input_.saddles.end());
    EXPECT_TRUE(search_.may_join(x, *saddle, d));
    ++meet;
  }
  EXPECT_GT(meet, 50U);
}

}  // namespace
}  // namespace affskel::core
