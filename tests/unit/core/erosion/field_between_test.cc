#include "core/erosion/field_between.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/lattice/lattice_coordinates.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// A field given by its formula, on the lattice of a box in a sheared frame.
class FieldBetweenTest : public ::testing::Test {
 protected:
  FieldBetweenTest() : solid_(make_solid(make_box(4, 3, 2))) {
    LatticeOptions options;
    options.spacing = 0.3;
    options.frame = {Vec3{1, 0, 0}, Vec3{0.3, 1, 0}, Vec3{0, -0.2, 1}};
    lattice_ = make_lattice(solid_, options);
    field_.spacing = lattice_.spacing;
  }

  Vec3 place(const Vec3& indices) const {
    return solid_.centre + solid_.scale() * scaled_place(lattice_, indices);
  }

  template <typename Erosion, typename Gradient>
  void fill(Erosion erosion, Gradient gradient) {
    std::vector<std::uint32_t> ranks(lattice_.points);
    for (std::uint32_t p = 0; p < lattice_.points; ++p) ranks[p] = p;
    for (const LatticePlace& at : lattice_places(lattice_, ranks)) {
      const Vec3 x = place({double(at[0]), double(at[1]), double(at[2])});
      field_.erosion.push_back(erosion(x));
      field_.gradient.push_back(transposed_times(frame_matrix(lattice_), gradient(x)));
    }
  }

  Solid solid_;
  Lattice lattice_;
  FrameField field_;
};

TEST_F(FieldBetweenTest, ALinearFieldIsExactEverywhere) {
  const Vec3 slope{3, -1, 2};
  fill([&](const Vec3& x) { return 20 + dot(slope, x); }, [&](const Vec3&) { return slope; });
  std::vector<Vec3> places;
  for (double i = 2; i < 9; i += 0.37)
    places.push_back({11 - i, 3 + 0.31 * i, 2.9 + 0.13 * i});  // not in order
  const std::vector<PlaceValue> values = field_between(lattice_, field_, places);
  for (std::size_t n = 0; n < places.size(); ++n) {
    EXPECT_NEAR(values[n].erosion, 20 + dot(slope, place(places[n])), 1e-12);
    EXPECT_NEAR(values[n].area, norm(slope), 1e-12);
  }
}

TEST_F(FieldBetweenTest, AtSamplePointsIsTheFieldItself) {
  fill([](const Vec3& x) { return std::exp(x.x) + x.y * x.y; },
       [](const Vec3& x) {
         return Vec3{std::exp(x.x), 2 * x.y, 0};
       });
  std::vector<std::uint32_t> ranks = {lattice_.points - 1, 17, lattice_.points / 2, 0};
  for (const std::uint32_t rank : ranks) {
    const LatticePlace at = lattice_places(lattice_, std::vector{rank}).front();
    // What a change of coordinates leaves of a whole number.
    const Vec3 place{at[0] + 1e-13, double(at[1]), at[2] - 1e-13};
    const PlaceValue value = field_between(lattice_, field_, std::vector{place}).front();
    EXPECT_EQ(value.erosion, field_.erosion[rank]);
    EXPECT_EQ(value.area, norm(inverse_transposed(frame_matrix(lattice_)) * field_.gradient[rank]));
  }
}

TEST_F(FieldBetweenTest, ErrorsFallWithTheSquareOfTheStep) {
  const auto erosion = [](const Vec3& x) { return 10 + x.x * x.x + x.y * x.z; };
  fill(erosion, [](const Vec3& x) { return Vec3{2 * x.x, x.z, x.y}; });
  // At the middle of a cell tangents err by half the second difference along its half diagonal, at most.
  const std::vector<Vec3> middle = {{5.5, 4.5, 2.5}};
  const double found = field_between(lattice_, field_, middle).front().erosion;
  EXPECT_NEAR(found, erosion(place(middle[0])), 0.3 * 0.3);
  EXPECT_NE(found, erosion(place(middle[0])));
}

TEST_F(FieldBetweenTest, TellsWhereThereIsNoSamplePoint) {
  fill([](const Vec3&) { return 1.0; }, [](const Vec3&) { return Vec3{}; });
  const std::vector<Vec3> far = {{-5, -5, -5}, {1000, 2, 2}};
  for (const PlaceValue& value : field_between(lattice_, field_, far)) EXPECT_TRUE(std::isnan(value.erosion));
  field_.erosion.assign(field_.erosion.size(), std::numeric_limits<double>::infinity());  // no direction
  EXPECT_TRUE(std::isnan(field_between(lattice_, field_, std::vector{Vec3{5.5, 4.5, 2.5}}).front().erosion));
}

}  // namespace
}  // namespace affskel::core
