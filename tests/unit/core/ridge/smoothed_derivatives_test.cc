#include "core/ridge/smoothed_derivatives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/chords/chord_fields.h"
#include "core/lattice/lattice_points.h"
#include "core/ridge/continued_field.h"
#include "core/ridge/local_depth.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// sqrt(E) = q: E = q^2, grad E = 2 q grad q.
struct Quadratic {
  double at(const Vec3& u) const {
    return 900 + 2 * u.x - u.y + 3 * u.z - u.x * u.x + 0.5 * u.y * u.y - 0.25 * u.z * u.z + 0.5 * u.x * u.y -
           0.75 * u.x * u.z + 0.2 * u.y * u.z;
  }
  Vec3 gradient(const Vec3& u) const {
    return {2 - 2 * u.x + 0.5 * u.y - 0.75 * u.z, -1 + u.y + 0.5 * u.x + 0.2 * u.z,
            3 - 0.5 * u.z - 0.75 * u.x + 0.2 * u.y};
  }
  Branch branch() const {
    return {[*this](const Vec3& u) { return at(u) * at(u); },
            [*this](const Vec3& u) { return 2 * at(u) * gradient(u); }};
  }
};

double highest(const FrameField& field) {
  return std::sqrt(*std::max_element(field.erosion.begin(), field.erosion.end()));
}

TEST(SmoothedDerivatives, OfAQuadraticAreItsOwnAtAnyWidth) {
  const BoxLattice box(25, 25, 25);
  const Quadratic q;
  const FrameField field = field_of_branches(box.lattice, {q.branch()});
  for (const double width : {1.0, 2.0, 3.3}) {
    const auto found =
        smoothed_derivatives(box.lattice, field, 1, nullptr, {.least = width, .greatest = width});
    for_each_point(box.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      // Where the kernel does not reach outside.
      if (std::min({i, j, k}) < 9 || std::max({i, j, k}) > 15) return;
      const Vec3 g = q.gradient({double(i), double(j), double(k)});
      const double unit = 1 / highest(field);
      EXPECT_NEAR(found[rank].gradient[0], unit * g.x, 2e-5);
      EXPECT_NEAR(found[rank].gradient[1], unit * g.y, 2e-5);
      EXPECT_NEAR(found[rank].gradient[2], unit * g.z, 2e-5);
      const double hessian[] = {-2, 0.5, -0.75, 1, 0.2, -0.5};
      for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(found[rank].hessian[n], unit * hessian[n], 2e-5) << n;
    });
  }
}

TEST(SmoothedDerivatives, BlendsTheWidthsBetweenThoseOfTheLadder) {
  const BoxLattice box(17, 17, 17);
  // E grows along x, its depth too: widths from the least to the largest.
  const FrameField field = field_of_branches(box.lattice, {linear_branch(1, {1, 0, 0})});
  const RidgeWidths widths{.least = 1, .greatest = 3};
  const auto found = smoothed_derivatives(box.lattice, field, 1, nullptr, widths);
  const std::vector<float> depth = local_depth(box.lattice, field);
  double least = 100, most = 0;
  for (std::size_t p = 0; p < found.size(); ++p) {
    EXPECT_EQ(found[p].depth, depth[p]);
    const double width = widths.at(double(depth[p]));
    EXPECT_EQ(width, std::clamp(0.35 * double(depth[p]), 1.0, 3.0));
    least = std::min(least, width);
    most = std::max(most, width);
  }
  EXPECT_EQ(least, 1);
  EXPECT_EQ(most, 3);
}

TEST(SmoothedDerivatives, DoNotDependOnTheNumberOfThreads) {
  const BoxLattice box(15, 9, 11);
  const FrameField field = field_of_branches(box.lattice, {Quadratic().branch()});
  const auto found = smoothed_derivatives(box.lattice, field, 1),
             same = smoothed_derivatives(box.lattice, field, 3);
  for (std::size_t p = 0; p < found.size(); ++p) {
    EXPECT_EQ(found[p].gradient, same[p].gradient);
    EXPECT_EQ(found[p].hessian, same[p].hessian);
  }
}

// The same field in numbers near the end of the range of a double.
TEST(SmoothedDerivatives, DoNotDependOnTheUnitOfE) {
  const BoxLattice box(9, 9, 9);
  const FrameField field = field_of_branches(box.lattice, {Quadratic().branch()});
  FrameField huge = field;
  for (double& e : huge.erosion) e = std::ldexp(e, 800);
  for (Vec3& g : huge.gradient) g = std::ldexp(1.0, 800) * g;
  const auto found = smoothed_derivatives(box.lattice, field), same = smoothed_derivatives(box.lattice, huge);
  for (std::size_t p = 0; p < found.size(); ++p) {
    EXPECT_EQ(found[p].gradient, same[p].gradient);
    EXPECT_EQ(found[p].hessian, same[p].hessian);
  }
}

float at(const ContinuedField& field, std::int32_t i, std::int32_t j, std::int32_t k) {
  return field.values[static_cast<std::size_t>(field.band.at(i, j, k))];
}

auto of(const std::vector<double>& values) {
  return [&values](std::uint32_t point) { return values[point]; };
}

TEST(ContinuedField, GoesOnLinearlyButNeitherBelowZeroNorUp) {
  const BoxLattice box(4, 4, 4);
  // 5 at z = 3, falling outwards by 2 a step there; rising by 1 a step towards z = 0 and beyond.
  std::vector<double> value(64);
  const auto gradient = [](std::uint32_t) { return Vec3{0, 0, -2}; };
  for_each_point(box.lattice, [&](std::int32_t, std::int32_t, std::int32_t k, std::uint32_t rank) {
    value[rank] = 11 - 2 * k;
  });
  const ContinuedField found =
      continued_field(box.lattice, of(value), gradient, std::vector<std::uint8_t>(64, 3));
  EXPECT_EQ(at(found, 1, 2, 2), 7);
  EXPECT_EQ(at(found, 1, 2, 4), 3);
  EXPECT_EQ(at(found, 1, 2, 5), 1);
  EXPECT_EQ(at(found, 1, 2, 6), 0);    // not -1
  EXPECT_EQ(at(found, 1, 2, -1), 11);  // not 13
  EXPECT_EQ(at(found, -2, 2, 1), 9);   // the nearest point's, the gradient being across
  EXPECT_EQ(at(found, -2, -2, 5), 1);
}

TEST(ContinuedField, TakesTheMeanOfPointsEquallyNear) {
  // Two boxes with a gap between them that holds one layer of places, k = 3.
  const Mesh box = make_box(3, 3, 3);
  const BoxLattice boxes(joined(box, moved(box, {0, 0, 4})));
  std::vector<double> value(54, 8);
  for_each_point(boxes.lattice, [&](std::int32_t, std::int32_t, std::int32_t k, std::uint32_t rank) {
    if (k > 3) value[rank] = 2;
  });
  const ContinuedField found = continued_field(
      boxes.lattice, of(value), [](std::uint32_t) { return Vec3{}; },
      std::vector<std::uint8_t>(value.size(), 2));
  ASSERT_EQ(at(found, 1, 1, 2), 8);
  ASSERT_EQ(at(found, 1, 1, 4), 2);
  EXPECT_EQ(at(found, 1, 1, 3), 5);
  EXPECT_EQ(at(found, -1, 1, 3), 5);
  EXPECT_EQ(at(found, -1, 1, 2), 8);
}

// What lies within a point's reach is what it is without bounds.
TEST(ContinuedField, GoesAsFarAsAnyPointReaches) {
  const BoxLattice boxes(joined(make_box(9, 7, 7), moved(make_box(3, 3, 3), {12, 2, 5})));
  const std::uint32_t count = boxes.lattice.points;
  std::vector<double> value(count);
  std::vector<std::uint8_t> reach(count);
  for (std::uint32_t p = 0; p < count; ++p) {
    value[p] = 1 + (p * 7919) % 101;
    reach[p] = static_cast<std::uint8_t>((p * 31) % 97 == 0 ? 5 : 1);
  }
  const auto gradient = [](std::uint32_t) { return Vec3{0.25, -0.5, 0.125}; };
  const auto whole = continued_field(boxes.lattice, of(value), gradient, std::vector<std::uint8_t>(count, 6));
  const auto bounded = continued_field(boxes.lattice, of(value), gradient, reach);
  std::size_t asked = 0;
  for_each_point(boxes.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
    const std::int32_t r = reach[rank];
    for (std::int32_t a = i - r; a <= i + r; ++a) {
      for (std::int32_t b = j - r; b <= j + r; ++b) {
        for (std::int32_t c = k - r; c <= k + r; ++c) {
          ++asked;
          EXPECT_EQ(at(bounded, a, b, c), at(whole, a, b, c));
        }
      }
    }
  });
  EXPECT_GT(asked, 10000U);
  EXPECT_LT(bounded.band.places(), whole.band.places());
}

TEST(LocalDepth, IsTheWayToWhatIsShallow) {
  const BoxLattice box(7, 7, 7);
  FrameField field = field_of_branches(box.lattice, {linear_branch(1000, {0, 0, 1})});
  std::uint32_t centre = 0;
  for_each_point(box.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
    if (i == 3 && j == 3 && k == 3) centre = rank;
  });
  field.erosion[centre] = 2;  // depth 2, all others about 1000
  const std::vector<float> depth = local_depth(box.lattice, field);
  for_each_point(box.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
    // A way over neighbours: diagonal steps first, the longest way's rest along an axis.
    std::array<int, 3> way = {std::abs(i - 3), std::abs(j - 3), std::abs(k - 3)};
    std::sort(way.begin(), way.end());
    const double length = way[0] * std::sqrt(3.0) + (way[1] - way[0]) * std::sqrt(2.0) + (way[2] - way[1]);
    EXPECT_NEAR(depth[rank], 2 + length, 1e-5);
  });
}

}  // namespace
}  // namespace affskel::core
