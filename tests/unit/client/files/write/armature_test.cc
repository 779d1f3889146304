#include "client/files/write/armature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "client/files/write/glb_writer.h"
#include "core/shapes/shapes.h"

namespace affskel::client {
namespace {

// A trunk up the z axis from 0 to 10, bent at 5 by a right angle towards x, and two limbs from its foot; about it a box.
// Part 0 is the trunk.
LimbedSurface bent() {
  LimbedSurface solid;
  const auto add = [&](const core::Vec3& at) {
    solid.places.push_back(at);
    return static_cast<std::uint32_t>(solid.places.size() - 1);
  };
  std::vector<std::uint32_t> trunk;
  for (int n = 0; n <= 5; ++n) trunk.push_back(add({0, 0, double(n)}));
  for (int n = 1; n <= 5; ++n) trunk.push_back(add({double(n), 0, 5}));
  solid.branches.push_back(trunk);
  for (const double y : {-1., 1.}) {
    std::vector<std::uint32_t> leg{trunk.front()};
    for (int n = 1; n <= 4; ++n) leg.push_back(add({0, y * n, -double(n)}));
    if (y > 0) std::reverse(leg.begin(), leg.end());  // its tip first
    solid.branches.push_back(leg);
  }
  solid.radius = {1, 0.5, 0.5};
  solid.surface = core::make_box(12, 12, 16, 4);
  for (core::Vec3& p : solid.surface.points) p = p - core::Vec3{6, 6, 6};
  for (const auto& [a, b, c] : solid.surface.triangles) {
    const double z = solid.surface.points[a].z + solid.surface.points[b].z + solid.surface.points[c].z;
    const double y = solid.surface.points[a].y + solid.surface.points[b].y + solid.surface.points[c].y;
    solid.triangle_part.push_back(z > 0 ? 0 : y < 0 ? 1 : 2);
  }
  return solid;
}

std::vector<std::uint32_t> of_part(const Armature& armature, std::uint32_t part) {
  std::vector<std::uint32_t> joints;
  for (std::uint32_t j = 0; j < armature.joints.size(); ++j)
    if (armature.joints[j].part == part) joints.push_back(j);
  return joints;
}

TEST(Armature, HasJointsWhereBranchesBeginEndAndBend) {
  const Armature armature = make_armature(bent());
  // The root and the beginning of the trunk stand at one place; then the bend and the tip.
  const std::vector<std::uint32_t> trunk = of_part(armature, 0);
  ASSERT_EQ(trunk.size(), 4U);
  EXPECT_EQ(armature.joints[trunk[0]].parent, Joint::kNone);
  EXPECT_EQ(armature.joints[trunk[0]].place, armature.joints[trunk[1]].place);
  EXPECT_EQ(armature.joints[trunk[2]].place, (core::Vec3{0, 0, 5}));
  EXPECT_EQ(armature.joints[trunk[3]].place, (core::Vec3{5, 0, 5}));
  for (const std::uint32_t leg : {1U, 2U}) {
    const std::vector<std::uint32_t> joints = of_part(armature, leg);
    ASSERT_EQ(joints.size(), 2U) << "straight";
    EXPECT_EQ(armature.joints[joints[0]].parent, trunk[0]) << "of its own, so that it turns alone";
    EXPECT_EQ(armature.joints[joints[0]].place, (core::Vec3{0, 0, 0})) << "from the joint to the tip";
    EXPECT_EQ(armature.joints[joints[1]].place.z, -4);
  }
  for (std::uint32_t j = 0; j < armature.joints.size(); ++j)
    EXPECT_TRUE(armature.joints[j].parent == Joint::kNone || armature.joints[j].parent < j);
}

TEST(Armature, VerticesFollowTheNearestBoneOfTheirParts) {
  const LimbedSurface solid = bent();
  const Armature armature = make_armature(solid);
  ASSERT_EQ(armature.bindings.size(), solid.surface.points.size());
  int blended = 0;
  for (std::size_t v = 0; v < armature.bindings.size(); ++v) {
    const Binding& binding = armature.bindings[v];
    std::set<std::uint32_t> parts;
    for (std::size_t t = 0; t < solid.surface.triangles.size(); ++t)
      for (const std::uint32_t corner : solid.surface.triangles[t])
        if (corner == v) parts.insert(solid.triangle_part[t]);
    EXPECT_TRUE(parts.contains(armature.joints[binding.joint[0]].part)) << v;
    EXPECT_GE(binding.share, 0.5);
    EXPECT_LE(binding.share, 1);
    blended += binding.share < 1;
    if (binding.share < 1) {
      EXPECT_EQ(armature.joints[binding.joint[0]].part, armature.joints[binding.joint[1]].part);
    }
  }
  EXPECT_GT(blended, 0) << "about the bend";
}

TEST(Armature, CutsALoopAndKeepsALonePlace) {
  LimbedSurface solid;
  for (int n = 0; n < 24; ++n) {
    const double angle = 2 * std::acos(-1.0) * n / 24;
    solid.places.push_back({4 * std::cos(angle), 4 * std::sin(angle), 0});
  }
  solid.places.push_back({9, 9, 9});
  solid.branches.resize(2);
  for (std::uint32_t n = 0; n <= 24; ++n) solid.branches[0].push_back(n % 24);
  solid.branches[1] = {24};
  solid.radius = {1, 1};
  solid.surface = core::make_box(2, 2, 2);
  solid.triangle_part.assign(solid.surface.triangles.size(), 1);
  const Armature armature = make_armature(solid);
  EXPECT_GE(of_part(armature, 0).size(), 4U);
  EXPECT_EQ(of_part(armature, 1).size(), 1U);
  EXPECT_EQ(std::count_if(armature.joints.begin(), armature.joints.end(),
                          [](const Joint& joint) { return joint.parent == Joint::kNone; }),
            2);
  for (const Binding& binding : armature.bindings) EXPECT_EQ(armature.joints[binding.joint[0]].part, 1U);
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

// The chunks and accessors are what glTF says; a joint's world place and its inverse bind matrix cancel out.
TEST(Glb, IsGltfWithASkin) {
  const LimbedSurface solid = bent();
  const Armature armature = make_armature(solid);
  std::string file;
  write_glb(solid, {"made by \"hand\""}, [&](std::string_view bytes) { file += bytes; });
  ASSERT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(file, 4), 2U);
  EXPECT_EQ(word_at(file, 8), file.size());
  const std::size_t length = word_at(file, 12);
  EXPECT_EQ(length % 4, 0U);
  const auto document = nlohmann::json::parse(file.substr(20, length));
  EXPECT_EQ(document["asset"]["extras"]["about"][0], "made by \"hand\"");
  const std::string binary = file.substr(28 + length);
  EXPECT_EQ(word_at(file, 20 + length), binary.size());
  EXPECT_EQ(document["buffers"][0]["byteLength"], binary.size());
  for (const auto& view : document["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), binary.size());
  }
  const auto values = [&](const nlohmann::json& accessor, std::size_t n) {
    const auto& view =
        document["bufferViews"]
                [document["accessors"][accessor.get<std::size_t>()]["bufferView"].get<std::size_t>()];
    float value = 0;
    std::memcpy(&value, binary.data() + view["byteOffset"].get<std::size_t>() + 4 * n, 4);
    return double{value};
  };
  const auto& nodes = document["nodes"];
  const auto& joints = document["skins"][0]["joints"];
  ASSERT_EQ(joints.size(), armature.joints.size());
  std::vector<core::Vec3> world(nodes.size());
  for (std::size_t n = 2; n < nodes.size(); ++n) {
    const auto& t = nodes[n]["translation"];
    world[n] = world[n] + core::Vec3{t[0], t[1], t[2]};
    for (const auto& child : nodes[n].value("children", nlohmann::json::array())) world[child] = world[n];
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const core::Vec3 at = world[joints[j]];
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(
          values(document["skins"][0]["inverseBindMatrices"], 16 * j + 12 + static_cast<std::size_t>(c)),
          -at[c], 1e-5);
  }
  const auto& attributes = document["meshes"][0]["primitives"][0]["attributes"];
  for (std::size_t v = 0; v < solid.surface.points.size(); ++v) {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += values(attributes["WEIGHTS_0"], 4 * v + k);
    EXPECT_EQ(sum, 1);
    // The root's translation puts the middle of the box back, z as glTF's y.
    const auto& back = nodes[0]["translation"];
    EXPECT_NEAR(values(attributes["POSITION"], 3 * v + 2) + back[1].get<double>(), solid.surface.points[v].z,
                1e-5);
  }
}

}  // namespace
}  // namespace affskel::client
