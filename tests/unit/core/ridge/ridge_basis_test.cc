#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "core/chords/chord_fields.h"
#include "core/ridge/ridge_constants.h"
#include "core/ridge/ridge_sheet.h"
#include "core/ridge/smoothed_derivatives.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// Of so many points limbs and derivatives are found at the same time.
TEST(RidgeBasis, OfAFineLatticeHasWhatEachStepGives) {
  const Solid solid = make_solid(make_box(12, 2, 2));
  LatticeOptions options;
  options.target_points = 550'000;
  const Lattice lattice = make_lattice(solid, options);
  ASSERT_GE(lattice.points, 500'000U);
  const FrameField field = field_of_branches(
      lattice, {{[](const Vec3& u) { return 400 - dot(u, u); }, [](const Vec3& u) { return -2.0 * u; }}});
  const RidgeBasis basis = ridge_basis(solid, lattice, field, 2);
  const std::vector<PointDerivatives> derivatives = smoothed_derivatives(lattice, field);
  ASSERT_EQ(basis.derivatives.size(), derivatives.size());
  for (std::size_t p = 0; p < derivatives.size(); ++p)
    ASSERT_TRUE(basis.derivatives[p].hessian == derivatives[p].hessian &&
                basis.derivatives[p].gradient == derivatives[p].gradient)
        << p;
  const std::vector<LimbTip> limbs =
      limb_tips(thinned_solid(basis.complex, basis.radius, field.erosion), RidgeConstants::limb_reach).tips;
  ASSERT_FALSE(limbs.empty());
  ASSERT_EQ(basis.limbs.size(), limbs.size());
  for (std::size_t n = 0; n < limbs.size(); ++n) EXPECT_EQ(basis.limbs[n].vertex, limbs[n].vertex);
}

}  // namespace
}  // namespace affskel::core
