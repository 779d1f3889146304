// Against all pairs: those that a plane is asked for join the same parts.
#include "core/infimum/crossing_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/split_mix64.h"
#include "core/infimum/piece_input.h"
#include "core/infimum/samples.h"
#include "core/infimum/section_loops.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// The parts of the surface below a plane, and what joins them.
class Parts {
 public:
  Parts(const Mesh& mesh, const Vec3& x, const Vec3& d)
      : mesh_(mesh), x_(x), d_(d), sets_(mesh.points.size()) {
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (below(t[k]) && below(t[(k + 1) % 3])) sets_.unite(t[k], t[(k + 1) % 3]);
      }
    }
  }

  bool below(std::uint32_t v) const { return dot(d_, mesh_.points[v] - x_) < -kTouchHeight; }

  void join(std::uint32_t first, std::uint32_t second) {
    const auto a = corner_below(first), b = corner_below(second);
    if (a && b) sets_.unite(*a, *b);
  }

  std::vector<std::uint32_t> numbers() {
    std::vector<std::uint32_t> numbers(mesh_.points.size());
    for (std::uint32_t v = 0; v < numbers.size(); ++v) numbers[v] = sets_.find(v);
    return numbers;
  }

 private:
  std::optional<std::uint32_t> corner_below(std::uint32_t triangle) const {
    for (const std::uint32_t v : mesh_.triangles[triangle]) {
      if (below(v)) return v;
    }
    return std::nullopt;
  }

  const Mesh& mesh_;
  const Vec3 x_, d_;
  DisjointSets sets_;
};

// Two numberings of the same parts.
bool same_parts(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  for (std::size_t v = 0; v < a.size(); ++v) {
    if ((a[v] == a[a[v]]) != (b[v] == b[a[v]]) || (a[v] == a[b[v]]) != (b[v] == b[b[v]])) return false;
  }
  return true;
}

struct Asked {
  std::size_t pairs = 0, asked = 0, joining_planes = 0;  // the last: at which pairs join parts
};

Asked expect_the_same_parts(const Mesh& mesh) {
  const Solid solid = make_solid(mesh);
  const PieceInput input(solid);
  std::set<std::pair<std::uint32_t, std::uint32_t>> all;  // with their triangles' new numbers
  for (std::uint32_t v = 0; v < input.mesh.points.size(); ++v) {
    for (const CrossingPairs::Crossing& crossing : input.crossings.at(v)) {
      EXPECT_TRUE(uses(input.mesh.triangles[crossing.triangle], v));
      all.insert(std::minmax(crossing.triangle, crossing.other));
    }
  }
  EXPECT_EQ(all.size(), solid.crossings.size());
  Asked count;
  FourTree::Lists lists;
  SplitMix64 random(11);
  for (const Vec3& x : places_of(lattice_of_points(solid, 300))) {
    const Vec3 d = draw_direction(random);
    Parts few(input.mesh, x, d), many = few, none = few;
    for (const auto& [i, j] : all) many.join(i, j);
    input.crossings.each_new(
        x, d, lists, [&](std::uint32_t v) { return few.below(v); },
        [&](const CrossingPair& pair) {
          few.join(pair.first, pair.second);
          ++count.asked;
        });
    EXPECT_TRUE(same_parts(few.numbers(), many.numbers()));
    count.joining_planes += !same_parts(none.numbers(), many.numbers());
    count.pairs += all.size();
  }
  return count;
}

TEST(CrossingPairsTest, FewPairsJoinWhatAllDoUnderNoise) {
  const Mesh body = make_body({.triangles = 1000});
  const Asked count = expect_the_same_parts(perturb(body, {.sigma = 0.01 * box_diagonal(body), .seed = 2}));
  EXPECT_GT(count.joining_planes, 30U);
  EXPECT_LT(20 * count.asked, count.pairs);
}

TEST(CrossingPairsTest, FewPairsJoinWhatAllDoOfSeveralShells) {
  const Mesh balls = joined(make_sphere(1, 500), joined(moved(make_sphere(1, 320), {1.5, 0, 0}),
                                                        moved(make_sphere(0.4, 80), {0.9, 0.1, 0.8})));
  const Asked count = expect_the_same_parts(balls);
  EXPECT_GT(count.joining_planes, 100U);
  EXPECT_LT(3 * count.asked, count.pairs);
}

TEST(CrossingPairsTest, OthersHaveNone) {
  const PieceInput input(make_solid(make_box(1, 2, 3)));
  EXPECT_TRUE(input.crossings.empty());
  EXPECT_TRUE(input.crossings.at(0).empty());
  FourTree::Lists lists;
  input.crossings.each_new(
      {}, {1, 0, 0}, lists, [](std::uint32_t) { return true; }, [](const CrossingPair&) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace affskel::core
