#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "core/lattice/lattice.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

TEST(Parallel, CallsEveryIndexOnce) {
  for (unsigned threads : {0U, 1U, 2U, 5U}) {
    for (std::size_t count : {0U, 1U, 3U, 1000U}) {
      std::vector<std::atomic<int>> calls(count);
      parallel_for(threads, count, [&](std::size_t i) { ++calls[i]; });
      for (const auto& n : calls) EXPECT_EQ(n, 1);
    }
  }
}

TEST(Parallel, ThrowsTheExceptionOfTheLeastIndex) {
  for (unsigned threads : {1U, 4U}) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      std::atomic<int> calls{0};
      try {
        parallel_for(threads, 1000, [&](std::size_t i) {
          ++calls;
          if (i >= 7) throw std::runtime_error(std::to_string(i));
        });
        FAIL() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_EQ(std::string(error.what()), "7");
      }
      EXPECT_LE(calls, 8 + 4) << "work goes on after a failure";
    }
  }
}

TEST(Parallel, RangesMakeUpTheWhole) {
  for (unsigned threads : {1U, 3U}) {
    for (std::size_t count : {0U, 1U, 1023U, 5000U, 1000003U}) {
      std::vector<std::uint8_t> seen(count, 0);
      parallel_ranges(threads, count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ++seen[i];
      });
      EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(count));
    }
  }
}

std::uint32_t counted_nodes(std::uint32_t count, std::uint32_t leaf) {
  if (count <= leaf) return 1;
  return 1 + counted_nodes(count / 2, leaf) + counted_nodes(count - count / 2, leaf);
}

TEST(Parallel, NodesOfAHalvingAreCountedRight) {
  for (std::uint32_t leaf : {1U, 3U, 4U, 7U}) {
    for (std::uint32_t count = 1; count < 700; ++count) {
      EXPECT_EQ(halving_nodes(count, leaf), counted_nodes(count, leaf)) << count << ' ' << leaf;
    }
  }
}

bool same(const AxisRuns& a, const AxisRuns& b) {
  const auto equal = [](const LatticeRun& s, const LatticeRun& t) {
    return s.first == t.first && s.length == t.length && s.low == t.low && s.high == t.high &&
           s.start == t.start;
  };
  return a.order == b.order &&
         std::equal(a.runs.begin(), a.runs.end(), b.runs.begin(), b.runs.end(), equal) &&
         std::equal(a.strays.begin(), a.strays.end(), b.strays.begin(), b.strays.end(), equal);
}

// Two bodies through each other: the lists of crossing pairs are longer than what is asked for.
TEST(Parallel, NothingPreparedDependsOnTheThreads) {
  Mesh mesh = make_torus(3, 1, 6000);
  const auto shift = static_cast<std::uint32_t>(mesh.points.size());
  const Mesh ball = make_sphere(3, 5000);
  for (const Vec3& p : ball.points) mesh.points.push_back(p + Vec3{0.3, 0.2, 0.1});
  for (const Triangle& t : ball.triangles)
    mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});

  const Solid one = make_solid(mesh, {true, true, 1}), three = make_solid(mesh, {true, true, 3});
  EXPECT_EQ(one.mesh.points, three.mesh.points);
  EXPECT_EQ(one.mesh.triangles, three.mesh.triangles);
  ASSERT_EQ(one.notes.size(), three.notes.size());
  ASSERT_TRUE(one.self_intersecting);
  EXPECT_EQ(one.notes.back().message, three.notes.back().message);
  for (std::size_t most : {std::size_t{3}, std::size_t{100000}}) {
    SelfIntersectionOptions serial, parallel;
    serial.max_pairs = parallel.max_pairs = most;
    parallel.threads = 3;
    const auto pairs = self_intersections(mesh, serial);
    EXPECT_GE(pairs.size(), 3U);
    EXPECT_EQ(pairs, self_intersections(mesh, parallel));
  }

  LatticeOptions serial, parallel;
  serial.target_points = parallel.target_points = 20000;
  parallel.threads = 3;
  const Lattice a = make_lattice(one, serial), b = make_lattice(one, parallel);
  EXPECT_EQ(a.points, b.points);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_TRUE(same(a.axis[axis], b.axis[axis])) << axis;
}

}  // namespace
}  // namespace affskel::core
