#include "published_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/erosion/directions.h"
#include "core/erosion/join_tree.h"
#include "core/lattice/all_places.h"
#include "core/lattice/lattice.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"
#include "open_surface.h"

namespace affskel::reference {
namespace {

using core::Arc;
using core::JoinTree;
using core::Mesh;
using core::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A stretch of the ray from a triangle's centre inside the solid: heights, and the triangle it begins at.
struct Stretch {
  double begin, end;
  std::uint32_t triangle;
};

// The field that the core's trees give under the published rule: direction n_i changes the points of the
// component that holds the advanced centre of triangle i, from that triangle up to v0/2.  This is the limit
// of the published program for vanishing steps.
class Limit {
 public:
  Limit(const Mesh& mesh, double spacing) : solid_(core::make_solid(mesh)) {
    core::LatticeOptions options;
    options.spacing = spacing;
    lattice_ = core::make_lattice(solid_, options);
    erosion_.assign(lattice_.points, kInfinity);
    const core::TreeInput input(solid_);
    core::JoinTreeBuilder builder(input);
    const core::DirectionSet normals = core::make_directions(solid_, "triangles");
    half_ = solid_.volume / std::pow(solid_.scale(), 3) / 2;
    for (std::uint32_t i = 0; i < normals.size(); ++i) direction(i, normals[i], builder.build(normals[i]));
  }

  const core::Solid& solid() const { return solid_; }

  // E in mesh units, +infinity where no direction applies.
  std::vector<double> erosion() const {
    std::vector<double> scaled = erosion_;
    for (double& e : scaled) e *= std::pow(solid_.scale(), 3);
    return scaled;
  }

  std::vector<Vec3> points() const { return core::all_places(solid_, lattice_); }

 private:
  std::array<Vec3, 3> corners(std::uint32_t t) const {
    const core::Triangle& c = solid_.mesh.triangles[t];
    return {solid_.mesh.points[c[0]], solid_.mesh.points[c[1]], solid_.mesh.points[c[2]]};
  }

  std::vector<Stretch> stretches(std::uint32_t i, const Vec3& d) const {
    const auto [a, b, c] = corners(i);
    Vec3 x = (1.0 / 3) * (a + b + c);
    x = x + 1e-6 * (a - x) + 3e-7 * (b - x);  // off the sides that symmetric solids have opposite centres
    std::vector<std::pair<double, std::uint32_t>> crossings = {{0, i}};
    for (std::uint32_t t = 0; t < solid_.mesh.triangles.size(); ++t) {
      const auto [p, q, r] = corners(t);
      const auto hit = t == i ? std::nullopt : meet(x, d, p, q, r);
      if (hit) crossings.push_back({hit->distance, t});
    }
    EXPECT_EQ(crossings.size() % 2, 0U);
    std::sort(crossings.begin(), crossings.end());
    std::vector<Stretch> all;
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
      all.push_back(
          {dot(d, x) + crossings[k].first, dot(d, x) + crossings[k + 1].first, crossings[k].second});
    return all;
  }

  static double volume_at(const JoinTree& tree, std::uint32_t arc, double h) {
    return tree.locate(tree.arcs[arc], h).volume_at(h);
  }

  void direction(std::uint32_t i, const Vec3& d, const JoinTree& tree) {
    for (const Stretch& stretch : stretches(i, d)) {
      for (const core::LatticeRun& run : lattice_.axis[2].runs) sweep_run(run, d, tree, stretch);
      if (volume_at(tree, tree.climb(stretch.triangle, stretch.end), stretch.end) >= half_) return;
    }
  }

  void sweep_run(const core::LatticeRun& run, const Vec3& d, const JoinTree& tree, const Stretch& stretch) {
    const core::LatticeGrid& grid = lattice_.grid;
    const std::uint32_t foot = dot(d, grid.axes[2]) >= 0 ? run.low : run.high;
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const Vec3 x = grid.origin + run.start[0] * grid.axes[0] + run.start[1] * grid.axes[1] +
                     (run.start[2] + n) * grid.axes[2];
      const double h = dot(d, x);
      if (h < stretch.begin || h > stretch.end) continue;
      const std::uint32_t arc = tree.climb(foot, h);
      if (arc != tree.climb(stretch.triangle, h)) continue;
      const double volume = volume_at(tree, arc, h);
      if (volume <= half_) erosion_[run.first + n] = std::min(erosion_[run.first + n], volume);
    }
  }

  core::Solid solid_;
  core::Lattice lattice_;
  std::vector<double> erosion_;
  double half_ = 0;  // v0 / 2, scaled units
};

struct Difference {
  double mean = 0;       // of |E - limit|, of v0, over the points that both have
  double largest = 0;    // of v0
  double far = 0;        // share of all points that differ by more than 1e-3 v0
  double one_sided = 0;  // share of the points that only one of them has
};

Difference difference(const std::vector<double>& field, const std::vector<double>& limit, double volume) {
  Difference d;
  std::size_t both = 0, one = 0;
  for (std::size_t p = 0; p < limit.size(); ++p) {
    const bool in_field = std::isfinite(field[p]), in_limit = std::isfinite(limit[p]);
    one += in_field != in_limit;
    if (!in_field || !in_limit) continue;
    ++both;
    const double off = std::abs(field[p] - limit[p]) / volume;
    d.mean += off;
    d.far += off > 1e-3;
    d.largest = std::max(d.largest, off);
  }
  d.mean /= static_cast<double>(std::max<std::size_t>(both, 1));
  d.far /= static_cast<double>(limit.size());
  d.one_sided = static_cast<double>(one) / static_cast<double>(limit.size());
  return d;
}

// Differences for steps first, first/2, first/4, ...
std::vector<Difference> convergence(const std::string& name, const Mesh& mesh, double spacing, double first,
                                    int halvings) {
  const Limit limit(mesh, spacing);
  const std::vector<double> expected = limit.erosion();
  std::vector<Difference> all;
  for (int k = 0; k <= halvings; ++k) {
    PublishedOptions options;
    options.spacing = spacing;
    options.step = std::ldexp(first, -k);
    options.every_point = false;
    const PublishedField field = published_program(mesh, options);
    const std::vector<Vec3> points = limit.points();
    EXPECT_EQ(field.points.size(), points.size());
    if (field.points.size() != points.size()) return all;
    for (std::size_t p = 0; p < points.size(); ++p)
      EXPECT_LT(norm(field.points[p] - points[p]), 1e-12 * limit.solid().scale());
    all.push_back(difference(field.erosion, expected, limit.solid().volume));
    std::cout << name << ": dD = " << options.step << ", mean " << all.back().mean << " v0, largest "
              << all.back().largest << " v0, beyond 1e-3 v0 " << all.back().far
              << " of the points, in one field only " << all.back().one_sided << ", " << field.planes
              << " planes, " << field.erosion_s << " s\n";
  }
  return all;
}

// Expects the mean difference to fall at least by `factor` with every halving of the step.
void expect_falling(const std::vector<Difference>& steps, double factor) {
  for (std::size_t k = 1; k < steps.size(); ++k) EXPECT_LT(steps[k].mean, factor * steps[k - 1].mean) << k;
}

// Volumes over a box's faces are linear, so that interpolation is exact with any step.
TEST(PublishedProgram, EqualsTheCoreOnABox) {
  for (const Difference& d : convergence("box", core::make_box(3, 2, 1, 2), 0.2, 0.2, 3)) {
    EXPECT_LT(d.largest, 1e-13);
    EXPECT_EQ(d.one_sided, 0);
  }
}

// Volumes are smooth: linear interpolation is good to the square of the step.
TEST(PublishedProgram, ApproachesTheCoreOnACone) {
  const auto steps = convergence("cone", core::make_cone(1, 2, 12), 0.15, 0.2, 4);
  expect_falling(steps, 0.5);
  EXPECT_LT(steps.back().mean, 1e-4);
}

TEST(PublishedProgram, ApproachesTheCoreOnATorus) {
  const auto steps = convergence("torus", core::make_torus(3, 1, 64), 0.4, 0.4, 4);
  expect_falling(steps, 0.5);
  EXPECT_LT(steps.back().mean, 1e-4);
}

TEST(PublishedProgram, ApproachesTheCoreOnACup) {
  const auto steps = convergence("cup", core::cup(12), 0.3, 0.4, 4);
  expect_falling(steps, 0.5);
  EXPECT_LT(steps.back().mean, 1e-4);
}

TEST(PublishedProgram, ApproachesTheCoreOnAHollowBall) {
  const auto steps = convergence("hollow ball", core::hollow_ball(), 0.6, 0.4, 2);
  expect_falling(steps, 0.5);
  EXPECT_LT(steps.back().mean, 1e-3);
}

// Planes from the bottom pass beside the cavity, whose part below them is an inner surface of its own: at
// v0/2 it takes a third of the volume.  Volumes are linear in each step.
TEST(PublishedProgram, EqualsTheCoreBesideACavity) {
  Mesh cavity = core::make_box(2.2, 3.2, 3);
  cavity = core::reversed(core::moved(cavity, {1.4, 0.4, 0.5}));
  for (const Difference& d :
       convergence("cavity", joined(core::make_box(4, 4, 4, 2), cavity), 0.3, 0.05, 1)) {
    EXPECT_LT(d.largest, 1e-12);
    EXPECT_EQ(d.one_sided, 0);
  }
}

// Limbs merge: within a step of a merge the interpolation is off by a whole limb, and the share of such
// points falls with the step.
TEST(PublishedProgram, ApproachesTheCoreOnABody) {
  const auto steps = convergence("body", core::make_body({200, 1800}), 40, 60, 5);
  expect_falling(steps, 0.8);
  EXPECT_LT(steps.back().mean, steps.front().mean / 8);
  EXPECT_LT(steps.back().far, steps.front().far / 8);
  for (const Difference& d : steps) EXPECT_LT(d.one_sided, 0.01);
}

PublishedField small_torus(PublishedOptions options) {
  options.spacing = 0.4;
  options.step = 0.2;
  return published_program(core::make_torus(3, 1, 64), options);
}

TEST(PublishedProgram, FieldDependsNeitherOnRaysNorOnPointsLookedAtTwice) {
  const PublishedField plain = small_torus({});
  PublishedOptions other;
  other.seed = 99;
  EXPECT_EQ(small_torus(other).erosion, plain.erosion);
  EXPECT_EQ(small_torus(other).triangle, plain.triangle);
  other.every_point = false;
  EXPECT_EQ(small_torus(other).erosion, plain.erosion);
  EXPECT_EQ(small_torus(other).planes, plain.planes);
}

TEST(PublishedProgram, PartsOfTheTrianglesMakeUpTheWhole) {
  const PublishedField whole = small_torus({});
  PublishedOptions even, odd;
  for (std::uint32_t i = 0; i < 64; ++i) (i % 2 == 0 ? even : odd).triangles.push_back(i);
  const PublishedField a = small_torus(even), b = small_torus(odd);
  EXPECT_EQ(a.planes + b.planes, whole.planes);
  for (std::size_t p = 0; p < whole.points.size(); ++p) {
    EXPECT_EQ(whole.erosion[p], std::min(a.erosion[p], b.erosion[p]));
    if (whole.triangle[p] == PublishedField::kNone) continue;
    EXPECT_EQ(whole.triangle[p] % 2 == 0 ? a.triangle[p] : b.triangle[p], whole.triangle[p]);
  }
}

TEST(PublishedProgram, RefusesWhatItCannotDo) {
  const Mesh box = core::make_box(1, 1, 1);
  PublishedOptions options;
  options.spacing = 0.3;
  EXPECT_THROW(published_program(box, options), std::invalid_argument);
  options.step = 0.1;
  options.triangles = {12};
  EXPECT_THROW(published_program(box, options), std::invalid_argument);
  options.triangles = {11};
  EXPECT_NO_THROW(published_program(box, options));
}

}  // namespace
}  // namespace affskel::reference
