#include "core/repair/flat_sheet.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "core/repair/repaired.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

std::string refusal(const Mesh& sheet, const RepairOptions& options) {
  try {
    repair_mesh(sheet, options);
  } catch (const CoreError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(FlatSheet, IsRefusedWithFillingsAndAWrapOfIt) {
  // Tilted, and rounded as in a file of single precision.
  Mesh sheet{{{0, 0, 0}, {1, 0, 0.3}, {0, 1, 0.7}, {1, 1, 1}}, {{0, 1, 2}, {1, 3, 2}}};
  for (Vec3& p : sheet.points) p.z = static_cast<float>(p.z);
  for (const RepairOptions& options :
       {RepairOptions{}, {.kind = RepairKind::kWrap}, {.longest_hole = 0.1}, {.longest_hole = 9}}) {
    const std::string said = refusal(sheet, options);
    EXPECT_NE(said.find("open sheet and flat"), std::string::npos) << said;
    EXPECT_EQ(said.find("alpha"), std::string::npos) << "no wrap of it is of use: " << said;
  }
  sheet.points[3].z = 1.1;
  EXPECT_NO_THROW(repair_mesh(sheet)) << "bent";
  EXPECT_NO_THROW(repair_mesh(make_box(1, 1, 1e-8))) << "a plate";
}

// Of a cone without its base the volume seems none from its tip.
TEST(FlatSheet, IsWhatLiesInAPlane) {
  const Mesh tip{{{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
  EXPECT_FALSE(is_flat_sheet(tip));
  EXPECT_NE(repair_mesh(tip).left.find("1 hole is left"), std::string::npos) << repair_mesh(tip).left;
  EXPECT_NEAR(repair_mesh(tip, {.longest_hole = 9}).volume, 1.0 / 6, 1e-12);
  EXPECT_TRUE(is_flat_sheet({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {5, 5, 5}}, {{0, 1, 2}}}))
      << "but for a point";
}

}  // namespace
}  // namespace affskel::core
