#include "core/spatial/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace affskel::core {
namespace {

std::vector<std::uint32_t> found_above(const BoxTree& tree, const Box& query, std::uint32_t above) {
  std::vector<std::uint32_t> found;
  tree.visit_above(query, above, [&](std::uint32_t index) { found.push_back(index); });
  std::sort(found.begin(), found.end());
  return found;
}

TEST(BoxTreeTest, FindsWhatASearchThroughAllFinds) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> place(0, 40), extent(0, 6);  // whole numbers: many boxes just touch
  for (const std::size_t count : {0u, 1u, 4u, 5u, 700u}) {
    std::vector<Box> boxes(count);
    for (Box& box : boxes) {
      for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = place(random);
        box.high[k] = box.low[k] + extent(random);
      }
    }
    const BoxTree tree(boxes);
    for (std::uint32_t i = 0; i < count; ++i) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t j = i + 1; j < count; ++j) {
        if (boxes[i].meets(boxes[j])) expected.push_back(j);
      }
      EXPECT_EQ(found_above(tree, boxes[i], i), expected);
    }
  }
}

// Counts the boxes that a search compares with its own.
struct CountedQuery {
  Box box;
  mutable std::size_t looks = 0;

  bool meets(const Box& other) const {
    ++looks;
    return box.meets(other);
  }
};

// The flat boxes of the faces of cubes round one another: no two faces of different cubes meet.  Their
// centres have two coordinates in common, so that a tree which goes by its boxes' sides never tells them
// apart.
std::vector<Box> faces_of_nested_cubes(int count) {
  std::vector<Box> faces;
  for (int i = 1; i <= count; ++i) {
    const double r = i;
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double at : {-r, r}) {
        faces.push_back({{-r, -r, -r}, {r, r, r}});
        faces.back().low[k] = faces.back().high[k] = at;
      }
    }
  }
  return faces;
}

TEST(BoxTreeTest, TellsFacesOfNestedCubesApart) {
  constexpr int kCubes = 4000;
  const std::vector<Box> faces = faces_of_nested_cubes(kCubes);
  const BoxTree tree(faces);
  std::size_t looks = 0, met = 0;
  for (const Box& face : faces) {
    const CountedQuery query{face};
    tree.visit(query, [&](std::uint32_t) { ++met; });
    looks += query.looks;
  }
  EXPECT_EQ(met, 30U * kCubes) << "itself and the four faces beside it";
  EXPECT_LT(looks, 500 * faces.size()) << "once more than 12,000 each";
}

TEST(BoxTreeTest, AnswersNothingFromAnEmptyTree) {
  EXPECT_TRUE(found_above(BoxTree(std::vector<Box>{}), {{0, 0, 0}, {1, 1, 1}}, 0).empty());
}

TEST(BoxTreeTest, BoxOfATriangleIsTight) {
  const Mesh mesh{{{1, 5, -1}, {0, 6, 2}, {3, 4, 0}}, {{0, 1, 2}}};
  const Box box = box_of(mesh, mesh.triangles[0]);
  EXPECT_EQ(box.low, (Vec3{0, 4, -1}));
  EXPECT_EQ(box.high, (Vec3{3, 6, 2}));
}

}  // namespace
}  // namespace affskel::core
