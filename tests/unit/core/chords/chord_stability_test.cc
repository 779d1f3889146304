#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/chords/chord_fields.h"
#include "core/chords/chord_sheet.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/quality/sheet_topology.h"
#include "core/quality/similarity.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/shocks/shock_operator.h"
#include "core/shocks/skeleton.h"
#include "core/solid/betti_numbers.h"
#include "core/solid/solid_frame.h"

// What the operators keep when the solid is mapped, its vertices are noisy or the spacing is halved.

namespace affskel::core {
namespace {

BettiNumbers betti(const ChordSheet& sheet) {
  Mesh mesh;
  for (const SheetVertex& v : sheet.vertices) mesh.points.push_back(v.position);
  mesh.triangles = sheet.triangles;
  return sheet_betti_numbers(mesh);
}

// The vertices at least `far` from the rim, and all of them.
std::vector<Vec3> vertices_of(const ErodedSolid& solid, const ChordSheet& sheet, double far) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : sheet.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  }
  std::vector<Vec3> rim, result;
  for (const auto& [edge, triangles] : edges) {
    if (triangles == 1) rim.push_back(solid.place(sheet.vertices[edge.first].position));
  }
  for (const SheetVertex& v : sheet.vertices) {
    const Vec3 p = solid.place(v.position);
    if (std::all_of(rim.begin(), rim.end(), [&](const Vec3& q) { return norm(p - q) >= far; }))
      result.push_back(p);
  }
  return result;
}

// The sheet itself: triangles sampled by their corners, the middles of their edges and their own.
std::vector<Vec3> sampled(const ErodedSolid& solid, const ChordSheet& sheet) {
  std::vector<Vec3> points = vertices_of(solid, sheet, 0);
  for (const Triangle& t : sheet.triangles) {
    const Vec3 p = solid.place(sheet.vertices[t[0]].position), q = solid.place(sheet.vertices[t[1]].position),
               r = solid.place(sheet.vertices[t[2]].position);
    for (const Vec3& middle : {0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p), (1.0 / 3) * (p + q + r)})
      points.push_back(middle);
  }
  return points;
}

struct HalvedSpacing {
  ErodedSolid coarse, fine;
  ChordSheet a, b;
  std::vector<Vec3> inner_a, inner_b;  // `far` coarse spacings and more from the sheet's own rim

  HalvedSpacing(const Mesh& mesh, double h, double far)
      : coarse(mesh, cubic_axes(h), "triangles"),
        fine(mesh, cubic_axes(h / 2), "triangles"),
        a(chord_sheet(coarse.solid, coarse.lattice, coarse.field)),
        b(chord_sheet(fine.solid, fine.lattice, fine.field)),
        inner_a(vertices_of(coarse, a, far * h)),
        inner_b(vertices_of(fine, b, far * h)) {}

  // From the inner vertices to the other sheet, rim and all.
  DistanceCurve there() const { return {inner_a, sampled(fine, b)}; }
  DistanceCurve back() const { return {inner_b, sampled(coarse, a)}; }
};

TEST(ChordSheet, HalvingTheSpacingHardlyMovesATorusSheet) {
  const double h = 0.1;
  const HalvedSpacing torus(make_torus(3, 1, 1024), h, 1);
  EXPECT_EQ(betti(torus.a), (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(betti(torus.b), (BettiNumbers{1, 1, 0}));
  ASSERT_GT(torus.inner_a.size(), 100U);
  ASSERT_GT(torus.inner_b.size(), 400U);
  EXPECT_LT(torus.there().hausdorff(), h / 2);
  EXPECT_LT(torus.back().hausdorff(), h / 2);
}

// An odd number of layers: those in the torus's plane have two equal chords at every point.
TEST(ChordSheet, IsOneAnnulusWhenSamplePointsLieOnIt) {
  for (const std::string directions : {"triangles", "sphere:2000"}) {
    for (const std::uint32_t triangles : {256U, 1024U}) {
      for (const double h : {0.14, 0.16, 0.23}) {
        const ErodedSolid torus(make_torus(3, 1, triangles), cubic_axes(h), directions);
        ASSERT_EQ(torus.lattice.grid.dims[2] % 2, 1U);
        const ChordSheet sheet = chord_sheet(torus.solid, torus.lattice, torus.field);
        EXPECT_EQ(betti(sheet), (BettiNumbers{1, 1, 0})) << directions << ", " << triangles << ", " << h;
      }
    }
  }
}

// An octagonal tube by its own directions alone: no wings where its sheet ends.
TEST(ChordSheet, StaysInThePlaneOfATorusOfFewTriangles) {
  const Mesh mesh = make_torus(4, 2, 256);
  for (const double h : {0.25, 0.2, 0.12, 0.1}) {
    SCOPED_TRACE(h);
    const ErodedSolid torus(mesh, cubic_axes(h), "triangles");
    const ChordSheet sheet = chord_sheet(torus.solid, torus.lattice, torus.field);
    EXPECT_EQ(betti(sheet), (BettiNumbers{1, 1, 0}));
    // With an odd number of layers one lies in the plane, and which of two equal chords counts there is
    // chance.
    const double bound = torus.lattice.grid.dims[2] % 2 == 0 ? 0.05 : 0.55;
    for (const SheetVertex& v : sheet.vertices) EXPECT_LT(std::abs(torus.place(v.position).z), bound * h);
  }
}

constexpr double kHeight = 18000, kSpacing = 100;
const double kDelta = std::sqrt(3.0) * kHeight / 128;

// Points of both operators, mesh coordinates.
struct Skeletons {
  std::vector<Vec3> zucker_hummel, chords;
};

Skeletons skeletons(const Mesh& mesh, FrameKind frame) {
  const Solid solid = make_solid(mesh);
  LatticeOptions options;
  options.spacing = kSpacing;
  options.frame = solid_frame(solid, frame);
  const Lattice lattice = make_lattice(solid, options);
  const DirectionSet directions = make_directions(solid, "triangles");
  Erosion erosion(solid, lattice, directions, {});
  std::vector<std::uint32_t> list(directions.size());
  std::iota(list.begin(), list.end(), 0U);
  std::stable_sort(list.begin(), list.end(), [](auto a, auto b) { return a % 64 < b % 64; });
  ExecutionContext context;
  erosion.run(list, context);
  std::vector<FieldValue> values;
  for (std::uint32_t p = 0; p < lattice.points; ++p) {
    values.push_back(erosion.field().value(p));
    values.back().area *= std::pow(solid.scale(), 2);
    values.back().erosion *= std::pow(solid.scale(), 3);
  }
  const FrameField field = frame_field(lattice, directions, values);
  const SamplePlaces places(solid, lattice);
  Skeletons result;
  std::vector<std::uint32_t> ranks;
  const auto divergence = core::divergence(ShockOperator::kZuckerHummel, lattice,
                                           frame_directions(lattice, directions), field.direction);
  for (const SkeletonPoint& kept : skeleton_points(divergence)) ranks.push_back(kept.point);
  for (const auto& [i, j, k] : lattice_places(lattice, ranks)) {
    result.zucker_hummel.push_back(places.at(i, j, k));
  }
  const Matrix3 f = frame_matrix(lattice);
  for (const ChordShock& shock : chord_sheet(solid, lattice, field).shocks) {
    const Vec3& u = shock.position;
    result.chords.push_back(places.origin() + (u.x * f[0] + (u.y * f[1] + u.z * f[2])));
  }
  return result;
}

using Map = std::function<Vec3(const Vec3&)>;

Mesh mapped(Mesh mesh, const Map& map) {
  for (Vec3& p : mesh.points) p = map(p);
  return mesh;
}

Skeletons mapped(Skeletons skeletons, const Map& map) {
  for (Vec3& p : skeletons.zucker_hummel) p = map(p);
  for (Vec3& p : skeletons.chords) p = map(p);
  return skeletons;
}

// Shares within delta both ways, per cent at least.
void expect_alike(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double there, double back,
                  const char* what) {
  const Similarity s = similarity(a, b);
  EXPECT_GE(100 * s.a_in_b.share_within(kDelta), there) << what;
  EXPECT_GE(100 * s.b_in_a.share_within(kDelta), back) << what;
}

Mesh body(std::uint32_t triangles) {
  MakeBodyOptions options;
  options.triangles = triangles;
  options.height = kHeight;
  return make_body(options);
}

// A body's sheet is a ribbon in limbs and has its rim near everywhere; where that itself moves, because the
// normals turn by hardly as much as they must, a few vertices are left alone.
TEST(ChordSheet, HalvingTheSpacingHardlyMovesABodysSheet) {
  for (const std::uint32_t triangles : {292U, 1000U}) {
    SCOPED_TRACE(triangles);
    const HalvedSpacing halved(body(triangles), kSpacing, 1);
    EXPECT_EQ(betti(halved.a).components, 1U);
    EXPECT_EQ(betti(halved.b).components, 1U);
    ASSERT_GT(halved.inner_a.size(), 400U);
    ASSERT_GT(halved.inner_b.size(), 1000U);
    EXPECT_GT(halved.there().share_within(kSpacing / 2), 0.94);
    EXPECT_GT(halved.back().share_within(kSpacing / 2), 0.95);
  }
}

class BodySkeletons : public testing::TestWithParam<std::uint32_t> {};

TEST_P(BodySkeletons, FollowShearAndStretch) {
  const Mesh mesh = body(GetParam());
  const Skeletons axis = skeletons(mesh, FrameKind::kAxis), affine = skeletons(mesh, FrameKind::kAffine);
  struct Case {
    const char* name;
    Map there, back;
  };
  for (const Case& c : {Case{"shear",
                             [](const Vec3& p) {
                               return Vec3{p.x, p.y + p.z, p.z};
                             },
                             [](const Vec3& p) {
                               return Vec3{p.x, p.y - p.z, p.z};
                             }},
                        Case{"stretch",
                             [](const Vec3& p) {
                               return Vec3{2 * p.x, p.y, p.z / 2};
                             },
                             [](const Vec3& p) {
                               return Vec3{p.x / 2, p.y, 2 * p.z};
                             }}}) {
    SCOPED_TRACE(c.name);
    const Mesh image = mapped(mesh, c.there);
    const Skeletons in_affine = mapped(skeletons(image, FrameKind::kAffine), c.back);
    expect_alike(affine.zucker_hummel, in_affine.zucker_hummel, 98, 98, "affine, Zucker-Hummel");
    expect_alike(affine.chords, in_affine.chords, 98, 98, "affine, chords");
    const Skeletons in_axis = mapped(skeletons(image, FrameKind::kAxis), c.back);
    // 90.8 and more measured: the generated bodies stay below the 94 of the real ones.
    expect_alike(axis.zucker_hummel, in_axis.zucker_hummel, 90, 90, "axis, Zucker-Hummel");
  }
}

TEST_P(BodySkeletons, SurviveNoiseOnTheVertices) {
  const Mesh mesh = body(GetParam());
  const Skeletons clean = skeletons(mesh, FrameKind::kAxis);
  for (const double percent : {0.5, 1.0}) {
    SCOPED_TRACE(percent);
    const Mesh noisy = perturb(mesh, {percent / 100 * box_diagonal(mesh), 1});
    const Skeletons other = skeletons(noisy, FrameKind::kAxis);
    const double bound = percent < 1 ? 95 : 92;
    // 90.1 measured at 292 triangles and 1 %.
    const double published = percent < 1 ? 95 : 89;
    expect_alike(clean.zucker_hummel, other.zucker_hummel, published, published, "Zucker-Hummel");
    expect_alike(clean.chords, other.chords, bound - 4, bound - 4, "chords");
  }
}

INSTANTIATE_TEST_SUITE_P(Triangles, BodySkeletons, testing::Values(292U, 1000U));

TEST(LargeBodySkeletons, SurviveNoiseOnTheVertices) {
  const Mesh mesh = body(5000);
  const Skeletons clean = skeletons(mesh, FrameKind::kAxis);
  const Skeletons other = skeletons(perturb(mesh, {0.01 * box_diagonal(mesh), 1}), FrameKind::kAxis);
  expect_alike(clean.zucker_hummel, other.zucker_hummel, 80, 93, "Zucker-Hummel");
  expect_alike(clean.chords, other.chords, 76, 89, "chords");
}

}  // namespace
}  // namespace affskel::core
