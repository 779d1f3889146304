#include "client/render/camera.h"

#include <gtest/gtest.h>

#include "client/base/error.h"

namespace affskel::client {
namespace {

using core::Vec3;

constexpr core::Stance kZ{{2, false}, {1, true}}, kY{{1, false}, {2, false}};

void expect_equal(const Vec3& a, const Vec3& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.z, b.z);
}

void expect_view(const char* camera, const core::Stance& stance, const Vec3& right, const Vec3& upward,
                 const Vec3& toward) {
  const View view = view_of(parse_camera(camera), stance);
  SCOPED_TRACE(camera);
  expect_equal(view.right, right);
  expect_equal(view.up, upward);
  expect_equal(view.toward, toward);
}

TEST(Camera, NamedViewsAreExact) {
  expect_view("front", kZ, {1, 0, 0}, {0, 0, 1}, {0, -1, 0});
  expect_view("side", kZ, {0, 1, 0}, {0, 0, 1}, {1, 0, 0});
  expect_view("top", kZ, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  expect_view("back", kZ, {-1, 0, 0}, {0, 0, 1}, {0, 1, 0});
  expect_view("left", kZ, {0, -1, 0}, {0, 0, 1}, {-1, 0, 0});
  expect_view("bottom", kZ, {1, 0, 0}, {0, -1, 0}, {0, 0, -1});
  expect_view("front", kY, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  expect_view("side", kY, {0, 0, -1}, {0, 1, 0}, {1, 0, 0});
  expect_view("top", kY, {1, 0, 0}, {0, 0, -1}, {0, 1, 0});
}

TEST(Camera, AnglesGiveAnOrthonormalView) {
  for (const char* text : {"30,20", "-75.5,-60", "400,89", "135,0", "oblique"}) {
    const View view = view_of(parse_camera(text), kY);
    const Vec3 across = core::cross(view.right, view.up);
    EXPECT_NEAR(core::norm(across - view.toward), 0, 1e-15) << text;
    EXPECT_NEAR(core::dot(view.right, view.up), 0, 1e-15) << text;
    EXPECT_NEAR(core::norm(view.up), 1, 1e-15) << text;
    EXPECT_EQ(view.right.y, 0) << text << ": the horizon is level";
  }
  // 30 degrees to the right of the front, which looks along z, and 30 above: (1/2 cos, sin, cos cos).
  const Vec3 toward = view_of(parse_camera("30,30"), kY).toward;
  EXPECT_NEAR(toward.x, 0.25 * std::sqrt(3), 1e-15);
  EXPECT_NEAR(toward.y, 0.5, 1e-15);
  EXPECT_NEAR(toward.z, 0.75, 1e-15);
}

TEST(Camera, RefusesWhatItDoesNotKnow) {
  for (const char* text : {"", "Front", "30", "30,", ",20", "30,20,5", "30,91", "nan,0", "inf,0", "30;20"}) {
    EXPECT_THROW(parse_camera(text), ClientError) << text;
  }
  EXPECT_EQ(parse_camera("30,-20").name, "azimuth 30, elevation -20");
}

}  // namespace
}  // namespace affskel::client
