#include "core/erosion/erosion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numeric>
#include <random>

#include "core/erosion/computed.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

constexpr double kPi = 3.14159265358979323846;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(Erosion, BoxCornersFollowTheirClosedForm) {
  const Computed box = compute(make_box(1, 1, 1), 0.05, "random:10000:1");
  std::vector<double> excess;
  for (std::size_t i = 0; i < box.place.size(); ++i) {
    const Vec3& x = box.place[i];
    const double a = std::min(x.x, 1 - x.x), b = std::min(x.y, 1 - x.y), c = std::min(x.z, 1 - x.z);
    if (a > 1.0 / 3 || b > 1.0 / 3 || c > 1.0 / 3) continue;
    const double infimum = 4.5 * a * b * c;
    ASSERT_GE(box.value[i].erosion, infimum - 1e-9);
    excess.push_back(box.value[i].erosion / infimum - 1);
  }
  ASSERT_GT(excess.size(), 1000U);
  std::nth_element(excess.begin(), excess.begin() + static_cast<std::ptrdiff_t>(excess.size() / 2),
                   excess.end());
  EXPECT_LT(excess[excess.size() / 2], 0.002);
}

TEST(Erosion, BoxCentreIsHalf) {
  const Computed box = compute_through_the_middle(make_box(1, 1, 1), 1.0 / 3, "triangles+random:1000:1");
  ASSERT_EQ(box.value.size(), 27U);
  EXPECT_NEAR(box.value[13].erosion, 0.5, 1e-12);
}

TEST(Erosion, TetrahedronFollowsItsClosedForm) {
  const Mesh mesh = make_tetrahedron(1);
  const Computed t = compute(mesh, 0.04, "random:4000:1");
  const auto& p = mesh.points;
  const double volume = t.solid.volume;
  std::vector<double> excess;
  for (std::size_t i = 0; i < t.place.size(); ++i) {
    std::array<double, 4> bary{};
    for (std::size_t k = 0; k < 4; ++k) {
      // Volume of the tetrahedron with x in the place of corner k.
      std::array<Vec3, 4> q = {p[0], p[1], p[2], p[3]};
      q[k] = t.place[i];
      const double whole = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
      bary[k] = dot(cross(q[1] - q[0], q[2] - q[0]), q[3] - q[0]) / whole;
    }
    std::sort(bary.begin(), bary.end());
    if (bary[2] > 1.0 / 3) continue;
    const double infimum = 27 * volume * bary[0] * bary[1] * bary[2];
    ASSERT_GE(t.value[i].erosion, infimum - 1e-9 * volume);
    excess.push_back(t.value[i].erosion / infimum - 1);
  }
  ASSERT_GT(excess.size(), 500U);
  EXPECT_LT(median(excess), 0.02);
}

double ball_infimum(double r, double p) {
  return kPi * (r - p) * (r - p) * (2 * r + p) / 3;
}

// The polyhedral ball lies inside the ball, so its chords are smaller by at most what the ball has more,
// and inside the polyhedron lies a ball of radius `inner`.
TEST(Erosion, BallFollowsItsClosedForm) {
  const Mesh mesh = make_sphere(1, 5120);
  const Computed ball = compute(mesh, 0.11, "sphere:2000");
  const double missing = 4 * kPi / 3 - ball.solid.volume;
  ASSERT_LT(missing, 0.01);
  for (std::size_t i = 0; i < ball.place.size(); ++i) {
    const double infimum = ball_infimum(1, norm(ball.place[i]));
    ASSERT_GE(ball.value[i].erosion, infimum - missing);
    ASSERT_LE(ball.value[i].erosion, infimum + 0.02);
    // One of the directions points within 0.04 of the centre's way.
    if (norm(ball.place[i]) > 0.3) {
      EXPECT_GT(dot(ball.directions[ball.value[i].direction], (-1 / norm(ball.place[i])) * ball.place[i]),
                0.98);
    }
  }
}

TEST(Erosion, EllipsoidFollowsItsClosedForm) {
  const Computed solid = compute(make_ellipsoid(3, 2, 1, 5120), 0.2, "triangles");
  const double missing = 8 * kPi - solid.solid.volume;
  for (std::size_t i = 0; i < solid.place.size(); ++i) {
    const Vec3& x = solid.place[i];
    const double infimum = 6 * ball_infimum(1, norm(Vec3{x.x / 3, x.y / 2, x.z}));
    ASSERT_GE(solid.value[i].erosion, infimum - missing);
    ASSERT_LE(solid.value[i].erosion, infimum + 0.02 * solid.solid.volume);
  }
}

TEST(Erosion, CopiesHaveTheFieldsOfTheOriginal) {
  const Mesh torus = make_torus(3, 1, 256);
  Mesh copies = torus;
  // Moves by whole spacings keep the lattice; equal sides keep it centred the same way.
  copies = joined(copies, moved(torus, {10, 0, 0}));
  copies = joined(copies, moved(torus, {20, 0, 0}));
  const Computed one = compute(torus, 0.25, "triangles");
  const Computed three = compute(copies, 0.25, "triangles");
  ASSERT_EQ(three.value.size(), 3 * one.value.size());
  for (std::size_t i = 0; i < three.value.size(); ++i) {
    EXPECT_NEAR(three.value[i].erosion, one.value[i % one.value.size()].erosion, 1e-11 * one.solid.volume);
  }
}

// A block [0, 3] x [0, 1] x [0, 2] with a notch from below between two legs.  Along the top of the notch,
// x = ridge, a plane that falls by `slope` along y first meets the saddle (ridge, 1/2, 1).
double notch_top(double y, double slope) {
  return 1 - slope * (y - 0.5) + 0.25 * std::abs(y - 0.5);
}

Mesh two_legs(double ridge, double slope) {
  Mesh mesh;
  for (const double y : {0.0, 0.5, 1.0}) {
    for (const Vec3& p : {Vec3{0, y, 0}, {ridge, y, notch_top(y, slope)}, {3, y, 0}, {3, y, 2}, {0, y, 2}}) {
      mesh.points.push_back(p);
    }
  }
  constexpr std::array<std::array<std::uint32_t, 3>, 3> kFront{{{0, 1, 4}, {1, 3, 4}, {1, 2, 3}}};
  for (const auto& [a, b, c] : kFront) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({c + 10, b + 10, a + 10});
  }
  for (std::uint32_t i = 0; i < 10; ++i) {
    const std::uint32_t j = i % 5 == 4 ? i - 4 : i + 1;
    mesh.triangles.push_back({i, i + 5, j});
    mesh.triangles.push_back({j, i + 5, j + 5});
  }
  return mesh;
}

// Volume of the legs below that plane per width of leg, within 5 %: the sides of the notch are a little bent.
double legs_below(double slope) {
  constexpr int kSlices = 1000;
  double sum = 0;
  for (int i = 0; i < kSlices; ++i) {
    const double y = (i + 0.5) / kSlices, level = 1 - slope * (y - 0.5);
    sum += 0.5 * level * level / notch_top(y, slope) / kSlices;
  }
  return sum;
}

// The volumes of a row's points below a direction, per width of leg.
std::vector<double> widths_along_row(double ridge, double slope, double tilt, std::vector<double>& at) {
  const Solid solid = make_solid(two_legs(ridge, slope));
  LatticeGrid grid = lattice_of(solid, 0.125).grid;
  for (const std::size_t k : {1U, 2U}) {
    grid.origin = grid.origin - 0.5 * grid.axes[k];
    ++grid.dims[k];
  }
  const Lattice lattice = make_lattice(solid, grid);
  const DirectionSet one = {(1 / std::hypot(1, slope)) * Vec3{tilt, slope, 1}};
  Erosion erosion(solid, lattice, one, {1, false, true});
  ExecutionContext context;
  erosion.run(std::array<std::uint32_t, 1>{0}, context);
  const SamplePlaces places(solid, lattice);
  std::vector<double> widths;
  for (const LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const Vec3 x = places.at(run.start[0], run.start[1], run.start[2] + n);
      if (std::abs(x.z - 1) > 1e-9 || std::abs(x.y - 0.5) > 1e-9) continue;
      widths.push_back(erosion.field().value(run.first + n).erosion * std::pow(solid.scale(), 3) /
                       legs_below(slope));
      at.push_back(x.x);
    }
  }
  return widths;
}

// A row through a saddle, all but level, comes from one leg into the other at the height where both join.
// Heights of vertices are rounded to more than the row rises.  A point's piece is its own leg or both.
TEST(Erosion, RowsThroughASaddleDoNotTakeTheOtherLeg) {
  for (const double ridge : {0.7, 1.1, 2.3}) {
    for (const double slope : {-0.5, 0.5}) {
      for (const double tilt : {-3e-15, 3e-15, -2e-14, 2e-14, 0.0}) {
        std::vector<double> at;
        const std::vector<double> widths = widths_along_row(ridge, slope, tilt, at);
        ASSERT_EQ(widths.size(), 24U);
        for (std::size_t i = 0; i < widths.size(); ++i) {
          const double own = at[i] < ridge ? ridge : 3 - ridge;
          EXPECT_LT(std::min(std::abs(widths[i] - own), std::abs(widths[i] - 3)), 0.2)
              << widths[i] << " at " << at[i] << ", ridge " << ridge << ", slope " << slope << ", tilt "
              << tilt;
        }
      }
    }
  }
}

// The prongs of a comb: only the piece that holds the point counts.
TEST(Erosion, CountsOnlyThePieceOfThePoint) {
  const Computed c = compute(comb(3), 0.5, "triangles");
  for (std::size_t i = 0; i < c.place.size(); ++i) {
    const Vec3& x = c.place[i];
    if (x.z > 2.9) continue;
    // Inside a prong the plane from below cuts off its tip, no matter how many prongs there are.
    EXPECT_LE(c.value[i].erosion, x.z + 1e-12);
  }
}

TEST(Erosion, AreaIsTheGradientAlongTheNormal) {
  const Computed solid = compute(make_torus(3, 1, 512), 0.2, "sphere:300");
  const TreeInput input(solid.solid);
  JoinTreeBuilder builder(input);
  std::size_t tested = 0;
  for (std::size_t i = 0; i < solid.value.size(); i += 97) {
    const FieldValue& value = solid.value[i];
    const Vec3& d = solid.directions[value.direction];
    const JoinTree& tree = builder.build(d);
    const double unit = solid.solid.scale();
    const double h = dot(d, (1 / unit) * (solid.place[i] - solid.solid.centre));
    // Some arc at this height has the field's value; its slope is the area.
    for (const Arc& arc : tree.arcs) {
      if (h < tree.cubics[arc.first_cubic].height || h >= arc.top) continue;
      const double step = 1e-5;
      const double v = tree.locate(arc, h).volume_at(h) * unit * unit * unit;
      if (std::abs(v - value.erosion) > 1e-12 * solid.solid.volume) continue;
      const double up = tree.locate(arc, h + step).volume_at(h + step),
                   down = tree.locate(arc, h - step).volume_at(h - step);
      EXPECT_NEAR(value.area, (up - down) / (2 * step) * unit * unit, 1e-3 * value.area + 1e-6);
      ++tested;
    }
  }
  EXPECT_GT(tested, 20U);
}

// In the plane of a torus every direction and its mirror image have equal chords, but for rounding.
TEST(Erosion, OfTwoMirrorImagesTheLesserIndexDecides) {
  const Computed torus = compute_through_the_middle(make_torus(3, 1, 256), 0.14, "triangles");
  std::size_t in_plane = 0;
  for (std::size_t p = 0; p < torus.place.size(); ++p) {
    if (std::abs(torus.place[p].z) > 1e-9) continue;
    ++in_plane;
    const Vec3& n = torus.directions[torus.value[p].direction];
    const auto image = std::find_if(torus.directions.begin(), torus.directions.end(), [&](const Vec3& d) {
      return norm(d - Vec3{n.x, n.y, -n.z}) < 1e-9;
    });
    ASSERT_NE(image, torus.directions.end());
    EXPECT_LE(torus.value[p].direction, static_cast<std::uint32_t>(image - torus.directions.begin()));
  }
  EXPECT_GT(in_plane, 1000U);
}

TEST(Erosion, PruningThreadsAndOrderDoNotChangeABit) {
  for (const Mesh& mesh : {make_torus(3, 1, 256), hollow_ball(), comb(4), make_box(3, 2, 1, 2)}) {
    const std::string set = "triangles+random:100:2";
    const Computed plain = compute(mesh, 0.15, set, {1, false, 0});
    EXPECT_TRUE(same_bytes(plain, compute(mesh, 0.15, set, {1, true, 0})));
    EXPECT_TRUE(same_bytes(plain, compute(mesh, 0.15, set, {2, true, 0})));
    EXPECT_TRUE(same_bytes(plain, compute(mesh, 0.15, set, {3, true, 11})));
    EXPECT_TRUE(same_bytes(plain, compute(mesh, 0.15, set, {1, true, 12})));
  }
}

TEST(Erosion, PruningLeavesOutMostOfTheWork) {
  const Solid solid = make_solid(make_sphere(1, 1280));
  LatticeOptions options;
  options.spacing = 0.05;
  const Lattice lattice = make_lattice(solid, options);
  const DirectionSet directions = make_directions(solid, "triangles");
  Erosion erosion(solid, lattice, directions, {});
  std::vector<std::uint32_t> list(directions.size());
  std::iota(list.begin(), list.end(), 0U);
  std::shuffle(list.begin(), list.end(), std::mt19937_64(1));
  ExecutionContext context;
  erosion.run(list, context);
  EXPECT_LT(erosion.cost().counts.evaluated, lattice.points * directions.size() / 4);
}

TEST(Erosion, MoreDirectionsNeverRaiseE) {
  const Computed few = compute(make_torus(3, 1, 256), 0.25, "triangles");
  const Computed more = compute(make_torus(3, 1, 256), 0.25, "triangles+random:500:3");
  ASSERT_EQ(few.value.size(), more.value.size());
  bool lower = false;
  for (std::size_t i = 0; i < few.value.size(); ++i) {
    ASSERT_LE(more.value[i].erosion, few.value[i].erosion);
    lower = lower || more.value[i].erosion < few.value[i].erosion;
  }
  EXPECT_TRUE(lower);
}

// A context that stops after some directions, and remembers which were done.
class Stopper : public ExecutionContext {
 public:
  explicit Stopper(std::size_t after) : left_(after) {}
  bool stop_requested() override { return left_ == 0; }
  void item_done(std::uint64_t item) override {
    const std::lock_guard<std::mutex> guard(mutex_);
    done.push_back(item);
    if (left_ > 0) --left_;
  }
  std::vector<std::uint64_t> done;

 private:
  std::atomic<std::size_t> left_;
  std::mutex mutex_;
};

TEST(Erosion, StopsBetweenDirectionsAndGoesOnWithoutLoss) {
  const Mesh mesh = make_torus(3, 1, 256);
  const Computed whole = compute(mesh, 0.25, "triangles");
  Erosion erosion(whole.solid, whole.lattice, whole.directions, {2, true, true});
  std::vector<std::uint32_t> list(whole.directions.size());
  std::iota(list.begin(), list.end(), 0U);
  while (!list.empty()) {
    Stopper stopper(60);
    erosion.run(list, stopper);
    std::vector<std::uint32_t> left;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (std::find(stopper.done.begin(), stopper.done.end(), i) == stopper.done.end())
        left.push_back(list[i]);
    }
    ASSERT_LT(left.size(), list.size());
    list.swap(left);
  }
  const double unit = std::pow(whole.solid.scale(), 3);
  std::size_t changed = 0;
  erosion.field().take_changes([&](std::uint32_t, const FieldValue&) { ++changed; });
  EXPECT_EQ(changed, whole.value.size());
  for (std::uint32_t p = 0; p < whole.value.size(); ++p) {
    EXPECT_EQ(erosion.field().value(p).erosion * unit, whole.value[p].erosion);
    EXPECT_EQ(erosion.field().value(p).direction, whole.value[p].direction);
  }
}

// Two boxes with a common face: lines leave one and enter the other at the same depth.
TEST(Erosion, SolidsThatTouchDoNotDependOnTheirOrder) {
  const Mesh low = make_box(1, 1, 1), high = moved(make_box(1, 1, 1), {0, 0, 1});
  const Computed one = compute(joined(low, high), 0.25, "random:200:1");
  const Computed other = compute(joined(high, low), 0.25, "random:200:1");
  const Computed single = compute(low, 0.25, "random:200:1");
  ASSERT_EQ(one.value.size(), 2 * single.value.size());
  for (std::size_t i = 0; i < one.value.size(); ++i) {
    EXPECT_NEAR(one.value[i].erosion, other.value[i].erosion, 1e-12);
    // Columns of 8 points: the lower 4 are the lower box's.
    EXPECT_NEAR(one.value[i].erosion, single.value[i / 8 * 4 + i % 4].erosion, 1e-12);
  }
}

}  // namespace
}  // namespace affskel::core
