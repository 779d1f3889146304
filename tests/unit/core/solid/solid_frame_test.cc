#include "core/solid/solid_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/plain_math.h"
#include "core/erosion/directions.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/solid/least_box.h"
#include "core/solid/moments.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Column by column; a turn about an axis in no special position (a unit quaternion's matrix).
Matrix3 turn() {
  const double n = std::sqrt(1 + 0.16 + 0.09 + 0.49);
  const double w = 1 / n, x = 0.4 / n, y = -0.3 / n, z = 0.7 / n;
  return {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          Vec3{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          Vec3{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

const Matrix3 kShear = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 1, 1}};  // y += z
const Matrix3 kStretch = {Vec3{2, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 0.5}};

Mesh mapped_by(Mesh mesh, const Matrix3& map, const Vec3& shift = {}) {
  for (Vec3& p : mesh.points) p = map * p + shift;
  return mesh;
}

// A box bent so that it has no symmetry left.
Mesh crooked() {
  Mesh mesh = make_box(3, 2, 1, 3);
  for (Vec3& p : mesh.points) {
    p = {p.x + 0.1 * p.y * p.y + 0.25 * p.z, p.y + 0.15 * p.x * p.x * p.z, p.z + 0.2 * p.x * p.x + 0.1 * p.y};
  }
  return mesh;
}

Matrix3 frame_of(const Mesh& mesh, FrameKind kind) {
  return solid_frame(make_solid(mesh), kind);
}

double distance(const Matrix3& a, const Matrix3& b) {
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, norm(a[k] - b[k]));
  return largest;
}

// Whether column k of `frame` is +-`axis`.
void expect_along(const Vec3& column, const Vec3& axis, double tolerance) {
  EXPECT_LT(std::min(norm(column - axis), norm(column + axis)), tolerance);
}

void expect_rotation(const Matrix3& f) {
  EXPECT_NEAR(determinant(f), 1, 1e-15);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(norm(f[k]), 1, 1e-15);
    EXPECT_NEAR(dot(f[k], f[(k + 1) % 3]), 0, 1e-15);
  }
}

TEST(CubeRoot, InvertsCubes) {
  for (double x = 1e-300; x < 1e300; x *= 1.7e5) EXPECT_NEAR(cube_root(x) / std::cbrt(x), 1, 5e-16) << x;
  EXPECT_EQ(cube_root(1), 1);
  EXPECT_EQ(cube_root(27), 3);
}

TEST(ParseFrame, KnowsFourNames) {
  EXPECT_EQ(parse_frame("axis"), FrameKind::kAxis);
  EXPECT_EQ(parse_frame("pca"), FrameKind::kPca);
  EXPECT_EQ(parse_frame("obb"), FrameKind::kObb);
  EXPECT_EQ(parse_frame("affine"), FrameKind::kAffine);
  EXPECT_THROW(parse_frame("Axis"), CoreError);
  EXPECT_THROW(parse_frame(""), CoreError);
}

TEST(SolidFrame, AxisIsTheIdentity) {
  EXPECT_EQ(frame_of(crooked(), FrameKind::kAxis), kIdentity3);
}

TEST(SolidFrame, PcaAndObbFindTheAxesOfATurnedBox) {
  // Longest along y, then z, then x.
  const Mesh box = mapped_by(make_box(1, 3, 2, 2), turn(), {10, 20, 30});
  for (const FrameKind kind : {FrameKind::kPca, FrameKind::kObb}) {
    const Matrix3 f = frame_of(box, kind);
    expect_rotation(f);
    const double tolerance = 1e-13;
    expect_along(f[0], turn()[1], tolerance);
    expect_along(f[1], turn()[2], tolerance);
    expect_along(f[2], turn()[0], tolerance);
  }
}

// Second moments do not see the box of a body whose mass lies off its middle.
TEST(SolidFrame, ObbFindsTheBoxOfALopsidedSolid) {
  const Mesh slab = make_box(4, 3, 1), block = moved(make_box(0.5, 0.75, 0.5), {0.1, 0.1, 1});
  const Mesh turned = mapped_by(joined(slab, block), turn());
  const Matrix3 f = frame_of(turned, FrameKind::kObb);
  expect_along(f[0], turn()[0], 1e-13);
  expect_along(f[1], turn()[1], 1e-13);
}

TEST(SolidFrame, PcaAndObbTurnWithTheSolid) {
  const Mesh mesh = crooked();
  for (const FrameKind kind : {FrameKind::kPca, FrameKind::kObb}) {
    const Matrix3 before = frame_of(mesh, kind), after = frame_of(mapped_by(mesh, turn(), {1, 2, 3}), kind);
    expect_rotation(before);
    EXPECT_LT(distance(after, turn() * before), 1e-12);
  }
}

TEST(SolidFrame, ObbIsTheSameEveryTime) {
  const Mesh mesh = crooked();
  const Matrix3 first = frame_of(mesh, FrameKind::kObb);
  frame_of(make_cone(1, 2, 7), FrameKind::kObb);  // draws from the same generator
  EXPECT_EQ(frame_of(mesh, FrameKind::kObb), first);
}

TEST(SolidFrame, AffineGoesAlongWithEveryMapOfDeterminantOne) {
  const Mesh mesh = crooked();
  const Matrix3 before = frame_of(mesh, FrameKind::kAffine);
  EXPECT_NEAR(determinant(before), 1, 1e-15);
  for (const Matrix3& map : {turn(), kShear, kStretch, kShear * turn() * kStretch}) {
    const Matrix3 after = frame_of(mapped_by(mesh, map, {-4, 5, 6}), FrameKind::kAffine);
    EXPECT_LT(distance(after, map * before), 1e-12);
  }
}

void expect_normal_form(const Solid& solid) {
  const Matrix3 back = inverse_transposed(solid_frame(solid, FrameKind::kAffine));
  Mesh whitened = solid.mesh;
  for (Vec3& p : whitened.points) p = transposed_times(back, p);
  const Moments moments = solid_moments(whitened);
  const double variance = moments.covariance[0].x;
  EXPECT_LT(distance(moments.covariance, variance * kIdentity3), 1e-14);
  // Turned so that the contrast of the kurtoses is stationary, each axis to its heavier side.
  const FourthMoments fourth = fourth_moments(whitened, moments.volume, moments.centroid, kIdentity3);
  const double square = variance * variance;
  const auto excess = [&](std::size_t i) { return fourth[i][i][i][static_cast<int>(i)] / square - 3; };
  for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 2}, {2, 0}}) {
    const double iiij = fourth[i][i][i][static_cast<int>(j)], jjji = fourth[j][j][j][static_cast<int>(i)];
    EXPECT_NEAR(excess(i) * iiij / square, excess(j) * jjji / square, 1e-13);
  }
  for (const Vec3& axis : kIdentity3) {
    EXPECT_GT(third_moment(whitened, moments.volume, moments.centroid, axis), 0);
  }
}

TEST(SolidFrame, AffineMakesSecondMomentsEqual) {
  expect_normal_form(make_solid(crooked()));
  // If one of the two has axes in right-handed order, the other has not.
  const Matrix3 mirror = {Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  expect_normal_form(make_solid(reversed(mapped_by(crooked(), mirror))));
}

// The mean of |w|^2 w w^T does not see the edges of a box, but the kurtosis does.  To within order and sign,
// which map the lattice onto itself.
TEST(SolidFrame, NoiseTurnsTheAffineFrameOfABoxALittle) {
  const Mesh box = mapped_by(make_box(3, 2, 1, 6), turn());
  const Matrix3 back = inverse_transposed(frame_of(box, FrameKind::kAffine));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Mesh noisy = perturb(box, {0.01 * box_diagonal(box), seed});
    const Matrix3 frame = frame_of(noisy, FrameKind::kAffine);
    for (const Vec3& column : frame) {
      const Vec3 axis = transposed_times(back, column);
      EXPECT_GT(std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)}), std::cos(0.1) * norm(axis))
          << seed;
    }
  }
}

// A mirror image of one half is the other: the axes come in pairs of equal kurtosis.
TEST(SolidFrame, AffineGoesAlongWithAMirrorSymmetricSolid) {
  const Mesh body = make_body({292, 1800});
  const Matrix3 before = frame_of(body, FrameKind::kAffine);
  for (const Matrix3& map : {turn(), kShear, kStretch, kShear * turn() * kStretch}) {
    EXPECT_LT(distance(frame_of(mapped_by(body, map), FrameKind::kAffine), map * before), 1e-11);
  }
}

TEST(SolidFrame, SymmetricSolidsKeepTheAxesOfTheMesh) {
  for (const FrameKind kind : {FrameKind::kPca, FrameKind::kObb, FrameKind::kAffine}) {
    EXPECT_LT(distance(frame_of(make_box(2, 2, 2), kind), kIdentity3), 1e-12);
  }
  // Any turn about z leaves the torus' moments alone; z is the shortest axis.
  EXPECT_LT(distance(frame_of(make_torus(4, 1, 512), FrameKind::kPca), kIdentity3), 1e-12);
  // The frame of a box is its stretch, that of an ellipsoid too.
  const double size = cube_root(6);
  const Matrix3 stretch = {Vec3{3 / size, 0, 0}, Vec3{0, 2 / size, 0}, Vec3{0, 0, 1 / size}};
  EXPECT_LT(distance(frame_of(make_box(3, 2, 1, 2), FrameKind::kAffine), stretch), 1e-12);
  EXPECT_LT(distance(frame_of(make_ellipsoid(3, 2, 1, 320), FrameKind::kAffine), stretch), 1e-12);
}

TEST(SolidFrame, FlatSolidsHaveAnAffineFrameToo) {
  const Matrix3 f = frame_of(make_box(1000, 1000, 1), FrameKind::kAffine);
  EXPECT_NEAR(f[0].x, 10, 1e-9);
  EXPECT_NEAR(f[2].z, 0.01, 1e-12);
}

std::vector<Vec3> places_of(const Solid& solid, const Lattice& lattice) {
  const SamplePlaces places(solid, lattice);
  std::vector<Vec3> result;
  for (const LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n)
      result.push_back(places.at(run.start[0], run.start[1], run.start[2] + n));
  }
  return result;
}

LatticeOptions options_for(const Solid& solid, FrameKind kind, double spacing) {
  LatticeOptions options;
  options.spacing = spacing;
  options.frame = solid_frame(solid, kind);
  return options;
}

TEST(MakeLattice, FollowsTheFrame) {
  // In their own frame all these boxes are the same; the lattice divides the sides without a rest.
  const Mesh box = make_box(3, 2, 1, 2);
  for (const FrameKind kind : {FrameKind::kPca, FrameKind::kObb}) {
    const Solid solid = make_solid(mapped_by(box, turn(), {7, 8, 9}));
    const Lattice lattice = make_lattice(solid, options_for(solid, kind, 0.25));
    EXPECT_EQ(lattice.points, 12U * 8 * 4);
    EXPECT_EQ(lattice.grid.dims, (std::array<std::uint32_t, 3>{12, 8, 4}));
    EXPECT_EQ(lattice.spacing, 0.25);
    const SamplePlaces places(solid, lattice);
    for (const Vec3& axis : places.axes()) EXPECT_NEAR(norm(axis), 0.25, 1e-14);
    // The frame comes back out of the lattice.
    EXPECT_LT(distance(frame_matrix(lattice), solid_frame(solid, kind)), 1e-14);
  }
}

TEST(MakeLattice, InTheAffineFrameGoesAlongWithTheMap) {
  const Matrix3 map = kShear * turn() * kStretch;
  const Solid before = make_solid(crooked()), after = make_solid(mapped_by(crooked(), map, {1, 2, 3}));
  const Lattice a = make_lattice(before, options_for(before, FrameKind::kAffine, 0.13)),
                b = make_lattice(after, options_for(after, FrameKind::kAffine, 0.13));
  ASSERT_EQ(a.grid.dims, b.grid.dims);
  ASSERT_EQ(a.points, b.points);
  ASSERT_GT(a.points, 1000U);
  const std::vector<Vec3> x = places_of(before, a), y = places_of(after, b);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT(norm(y[i] - (map * x[i] + Vec3{1, 2, 3})), 1e-11);
}

TEST(MakeDirections, OfTheSphereGoAlongWithTheFrame) {
  const Matrix3 map = kShear * turn() * kStretch;
  const Solid before = make_solid(crooked()), after = make_solid(mapped_by(crooked(), map));
  const auto set_of = [](const Solid& solid) {
    DirectionOptions options;
    options.frame = solid_frame(solid, FrameKind::kAffine);
    return make_directions(solid, "triangles+sphere:80+random:50:3", options);
  };
  const DirectionSet a = set_of(before), b = set_of(after);
  ASSERT_EQ(a.size(), b.size());
  const Matrix3 covector = inverse_transposed(map);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(norm(b[i]), 1, 1e-15);
    const Vec3 wanted = covector * a[i];
    EXPECT_LT(norm(b[i] - (1 / norm(wanted)) * wanted), 1e-11);
  }
  EXPECT_NE(a.back(), make_directions(before, "random:50:3").back());
}

}  // namespace
}  // namespace affskel::core
