#include "core/curve/hub_stars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/none.h"
#include "core/curve/drawn_lines.h"
#include "core/mesh/edges.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// A plate, 12 by 12 and 2 thick, with lines in its middle, and a hub of so large axes, along these, in its middle.
struct Plate : DrawnLines {
  const LimbSurface surface;
  Vec3 middle{6, 6, 1};
  LimbHubs hubs;
  SheetMesh curve;
  std::vector<std::uint32_t> number;

  // From both ends of a link beside the middle out to the rim.
  explicit Plate(const Mesh& mesh = make_box(12, 12, 2)) : surface(mesh) {
    const std::uint32_t one = add(middle + Vec3{-1, 0.5, 0}, 1);
    const std::uint32_t other = go(one, {0.1, 0, 0}, 20, 1);
    go(one, {-0.08, 0.06, 0}, 45, 1);
    go(one, {-0.08, -0.06, 0}, 45, 1);
    go(other, {0.08, 0.06, 0}, 45, 1);
    go(other, {0.08, -0.06, 0}, 45, 1);
  }
  // @param other the joint of another hub, of that alone.
  void draw(const Vec3& axes = {3, 3, 1}, std::uint32_t other = kNone) {
    const auto square = [](double axis) { return 1 / (axis * axis); };
    hubs.hubs = {{{middle, {{{square(axes.x), 0, 0}, {0, square(axes.y), 0}, {0, 0, square(axes.z)}}}}, 0}};
    for (const Vec3& at : places) {
      hubs.of.push_back(hubs.hubs[0].outside(at) < 0 ? 0 : kNone);
      curve.vertices.emplace_back().position = at;
      curve.part.push_back(0);
    }
    if (other != kNone) {
      hubs.hubs.push_back({{places[other], kIdentity3}, other});
      hubs.of[other] = 1;
    }
    curve.segments = segments;
    number = draw_hub_stars(surface, 0.1, hubs, curve);
  }
  std::size_t ends() const {
    const Adjacency beside = neighbours(curve.vertices.size(), curve.segments);
    std::size_t ends = 0;
    for (std::size_t v = 0; v < beside.size(); ++v) ends += beside[v].size() == 1;
    return ends;
  }
};

TEST(HubStars, LeadFromLimbsToTheMiddle) {
  Plate plate;
  plate.draw();
  ASSERT_EQ(plate.number.size(), plate.places.size());
  const std::uint32_t joint = plate.hubs.hubs[0].joint;
  EXPECT_LT(norm(plate.curve.vertices[joint].position - plate.middle), 1e-12);
  const Adjacency beside = neighbours(plate.curve.vertices.size(), plate.curve.segments);
  for (std::uint32_t v = 0; v < beside.size(); ++v) EXPECT_EQ(beside[v].size() > 2, v == joint) << v;
  EXPECT_EQ(beside[joint].size(), 4U);
  EXPECT_EQ(plate.ends(), 4U);
  EXPECT_EQ(plate.curve.vertices.size(), plate.curve.segments.size() + 1) << "still a tree";
  ASSERT_EQ(plate.curve.part.size(), plate.curve.vertices.size());
  ASSERT_EQ(plate.hubs.of.size(), plate.curve.vertices.size());
  for (const auto& [a, b] : plate.curve.segments)
    EXPECT_LT(norm(plate.curve.vertices[a].position - plate.curve.vertices[b].position), 0.13);
  for (std::uint32_t v = 0; v < plate.places.size(); ++v) {
    const bool is_hubs = norm(plate.places[v] - plate.middle) < 3;
    EXPECT_EQ(plate.number[v] == joint, is_hubs) << v;
    if (!is_hubs) {
      EXPECT_EQ(plate.curve.vertices[plate.number[v]].position, plate.places[v]) << v;
    }
    EXPECT_EQ(plate.hubs.of[plate.number[v]], is_hubs ? 0U : kNone) << v;
  }
}

// Of a seat's leg, whose line ends in the plane of the seat.
TEST(HubStars, TurnIntoThePlane) {
  Plate plate;
  plate.go(plate.add({6, 9.5, 0.35}, 1), {0, 0, -0.1}, 2, 1);
  const auto foot = static_cast<std::uint32_t>(plate.places.size() - 3);
  plate.join(plate.add({6, 8.5, 1}, 1), foot);  // its vertex within
  plate.join(foot + 3, 0);
  plate.draw();
  ASSERT_FALSE(plate.number.empty());
  for (const SheetVertex& vertex : plate.curve.vertices) {
    EXPECT_LE(vertex.position.z, 1 + 1e-12);
    if (norm(vertex.position - plate.middle) < 2) {
      EXPECT_GT(vertex.position.z, 0.9);
    }
  }
}

TEST(HubStars, HaveNoLineForALimbThatIsHeldWhole) {
  Plate plate;
  const std::uint32_t end = plate.go(0, {0, 0.1, 0}, 10, 1);
  plate.draw();
  ASSERT_FALSE(plate.number.empty());
  EXPECT_EQ(plate.number[end], plate.hubs.hubs[0].joint);
  EXPECT_EQ(plate.ends(), 4U);
}

TEST(HubStars, AreOfPlatesAlone) {
  for (const Vec3& axes : {Vec3{3, 3, 2}, Vec3{5, 2.2, 1}}) {
    Plate plate;
    plate.draw(axes);
    EXPECT_TRUE(plate.number.empty());
    EXPECT_EQ(plate.curve.segments, plate.segments) << "as they were";
  }
}

TEST(HubStars, KeepTunnels) {
  Plate plate;
  plate.join(plate.go(0, {0.2, 0.1, 0}, 4, 1), 15);
  plate.draw();
  EXPECT_TRUE(plate.number.empty());
}

TEST(HubStars, StayInTheSolid) {
  Plate plate;
  for (Vec3& at : plate.places) at.z += 3;  // above it, all of them
  plate.middle.z += 3;
  plate.draw();
  EXPECT_TRUE(plate.number.empty());
}

// What lies between a limb and the middle, 0.3 wide, leaves lines beside it, and none through it.
TEST(HubStars, KeepOffTheSurface) {
  Mesh slot = make_box(0.3, 0.3, 1);
  for (Vec3& p : slot.points) p = p + Vec3{7.2, 6.75, 0.5};
  Plate plate(joined(make_box(12, 12, 2), reversed(slot)));
  plate.draw();
  EXPECT_TRUE(plate.number.empty());
}

// Two hubs, of which one stays as it is: its joint has another number.
TEST(HubStars, LeaveOtherHubsTheirJoints) {
  Plate plate;
  const std::uint32_t far = plate.add({6, 11, 1}, 1);
  plate.draw({3, 3, 1}, far);
  ASSERT_EQ(plate.hubs.hubs.size(), 2U);
  const std::uint32_t joint = plate.hubs.hubs[1].joint;
  EXPECT_EQ(joint, plate.number[far]);
  ASSERT_LT(joint, plate.curve.vertices.size());
  EXPECT_EQ(plate.curve.vertices[joint].position, plate.places[far]);
  EXPECT_EQ(plate.hubs.of[joint], 1U);
}

}  // namespace
}  // namespace affskel::core
