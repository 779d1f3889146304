#include "core/solid/stance.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

template <typename Map>
Mesh mapped(Mesh mesh, const Map& map) {
  for (Vec3& p : mesh.points) p = map(p);
  return mesh;
}

// Turned so that it stands as told; it stands as usual.
Mesh standing(const Mesh& mesh, const Stance& stance) {
  return mapped(mesh, [&](const Vec3& p) {
    return p.x * stance.right() + (p.z * stance.up.vector() - p.y * stance.front.vector());
  });
}

Mesh box(const Vec3& centre, const Vec3& size) {
  return mapped(make_box(size.x, size.y, size.z), [&](const Vec3& p) { return centre + (p - 0.5 * size); });
}

// Of boxes: trunk, four legs, neck, head and tail; up is z, in front -y.
Mesh animal() {
  Mesh all;
  const std::vector<std::array<Vec3, 2>> parts = {{Vec3{0, 0, 1}, Vec3{0.5, 1.6, 0.6}},
                                                  {Vec3{0.2, 0.7, 0.35}, Vec3{0.14, 0.14, 0.7}},
                                                  {Vec3{-0.2, 0.7, 0.35}, Vec3{0.14, 0.14, 0.7}},
                                                  {Vec3{0.2, -0.7, 0.35}, Vec3{0.14, 0.14, 0.7}},
                                                  {Vec3{-0.2, -0.7, 0.35}, Vec3{0.14, 0.14, 0.7}},
                                                  {Vec3{0, -0.9, 1.35}, Vec3{0.25, 0.3, 0.7}},
                                                  {Vec3{0, -1.1, 1.6}, Vec3{0.3, 0.6, 0.3}},
                                                  {Vec3{0, 0.95, 1}, Vec3{0.06, 0.4, 0.06}}};
  for (const auto& [centre, size] : parts) {
    const Mesh part = box(centre, size);
    const auto first = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), part.points.begin(), part.points.end());
    for (const Triangle& t : part.triangles)
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

// Every way to stand on z or y, seen from any side.
std::vector<Stance> stances() {
  std::vector<Stance> all;
  for (const std::size_t up : {std::size_t{1}, std::size_t{2}}) {
    for (std::size_t front = 0; front < 3; ++front)
      for (const bool minus : {false, true})
        if (front != up) all.push_back({{up, false}, {front, minus}});
  }
  return all;
}

std::string text(const Stance& stance) {
  const auto name = [](const AxisDirection& d) { return std::string(d.minus ? "-" : "") + "xyz"[d.axis]; };
  return name(stance.up) + " up, " + name(stance.front) + " in front";
}

void expect_found(const Mesh& mesh, const char* what) {
  for (const Stance& stance : stances())
    EXPECT_EQ(text(find_stance(standing(mesh, stance))), text(stance)) << what;
}

TEST(Stance, OfBodies) {
  const Mesh body = make_body();
  expect_found(body, "as it is");
  expect_found(make_body({.triangles = 5000}), "finer");
  // As wide as high.
  expect_found(mapped(body, [](const Vec3& p) { return Vec3{2.2 * p.x, 0.7 * p.y, p.z}; }), "arms spread");
  expect_found(perturb(body, {.sigma = 0.005 * box_diagonal(body)}), "noise");
  expect_found(mapped(body,
                      [](const Vec3& p) {
                        return Vec3{1e-3 * p.x + 7, 1e-3 * p.y, 1e-3 * p.z - 4};
                      }),
               "in metres");
}

TEST(Stance, OfAnimals) {
  expect_found(animal(), "long");
  // A giraffe: longer upwards, but not by much.
  expect_found(mapped(animal(), [](const Vec3& p) { return Vec3{p.x, p.y, 1.4 * p.z}; }), "high");
}

TEST(Stance, FrontIsFoundWhereUpIsKnown) {
  const Mesh body = make_body();
  for (std::size_t up = 0; up < 3; ++up) {
    for (std::size_t front = 0; front < 3; ++front) {
      if (front == up) continue;
      const Stance stance{{up, up == 1}, {front, up == 2}};
      EXPECT_EQ(text(find_stance(standing(body, stance), stance.up)), text(stance));
    }
  }
}

TEST(Stance, IsUsualWhereTheShapeDoesNotTell) {
  const Stance usual{{2, false}, {1, true}};
  EXPECT_EQ(find_stance(make_box(1, 1, 1)), usual);
  EXPECT_EQ(find_stance(make_box(12, 12, 4)), usual);
  EXPECT_EQ(find_stance(make_box(3, 1, 1)), usual);
  EXPECT_EQ(find_stance(make_box(1, 1.2, 1)), usual) << "hardly longer";
  EXPECT_EQ(text(find_stance(make_box(1, 1.3, 1))), "y up, z in front");
  EXPECT_EQ(text(find_stance(make_box(1, 1, 1), AxisDirection{0, false})), "x up, z in front");
}

// What is turned on a lathe about z: a bowl, a spherical shell cut in half, would roll on its side.
TEST(Stance, OfWhatIsTurnedIsItsAxis) {
  constexpr std::size_t kRound = 20, kHigh = 6;
  Mesh bowl;
  for (const double radius : {80.0, 70.0}) {
    for (std::size_t ring = 0; ring <= kHigh; ++ring) {
      const double slope = std::numbers::pi / 2 * double(ring) / kHigh;
      for (std::size_t k = 0; k < kRound; ++k) {
        const double turn = 2 * std::numbers::pi * double(k) / kRound;
        bowl.points.push_back({radius * std::sin(slope) * std::cos(turn),
                               radius * std::sin(slope) * std::sin(turn), -radius * std::cos(slope)});
      }
    }
  }
  const auto add = [&](std::size_t low, std::size_t high) {
    for (std::size_t k = 0; k < kRound; ++k) {
      const auto a = std::uint32_t(low * kRound + k), b = std::uint32_t(low * kRound + (k + 1) % kRound);
      const auto c = std::uint32_t(high * kRound + k), d = std::uint32_t(high * kRound + (k + 1) % kRound);
      bowl.triangles.push_back({a, b, d});
      bowl.triangles.push_back({a, d, c});
    }
  };
  for (std::size_t ring = 0; ring < kHigh; ++ring) {
    add(ring, ring + 1);
    add(kHigh + 2 + ring, kHigh + 1 + ring);
  }
  add(kHigh, 2 * kHigh + 1);
  for (const Stance& stance : {Stance{{2, false}, {1, true}}, Stance{{1, false}, {2, false}}})
    EXPECT_EQ(text(find_stance(standing(bowl, stance))), text(stance));
}

// Letters are read from where they face, or from above.
TEST(Stance, OfFlatPartsShowsThemFlat) {
  Mesh letter = box({0.05, 0.5, 0.1}, {0.1, 1, 0.2});
  for (const double y : {0.05, 0.95}) {
    const Mesh arm = box({0.35, y, 0.1}, {0.5, 0.1, 0.2});
    const auto first = static_cast<std::uint32_t>(letter.points.size());
    letter.points.insert(letter.points.end(), arm.points.begin(), arm.points.end());
    for (const Triangle& t : arm.triangles)
      letter.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  EXPECT_EQ(text(find_stance(mapped(letter,
                                    [](const Vec3& p) {
                                      return Vec3{p.x, p.y, p.z / 8};
                                    }))),
            "z up, -y in front");
  EXPECT_EQ(text(find_stance(mapped(letter,
                                    [](const Vec3& p) {
                                      return Vec3{p.x, -p.z / 8, p.y};
                                    }))),
            "z up, -y in front");
  EXPECT_EQ(text(find_stance(mapped(letter,
                                    [](const Vec3& p) {
                                      return Vec3{p.z / 8, p.x, p.y};
                                    }))),
            "z up, x in front");
}

TEST(Stance, IsUsualWithoutASurface) {
  Mesh flat;
  flat.points = {{0, 0, 0}, {1, 1, 1}};
  flat.triangles = {{0, 1, 1}};
  EXPECT_EQ(find_stance(flat), Stance());
  flat.points[1] = {1e300, -1e300, 0};
  EXPECT_EQ(find_stance(flat), Stance());
}

TEST(Stance, DoesNotDependOnTheSenseOfTheFaces) {
  Mesh mesh = standing(animal(), {{1, false}, {0, true}});
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(text(find_stance(mesh)), "y up, -x in front");
}

TEST(Stance, RightIsRightHanded) {
  for (const Stance& stance : stances())
    EXPECT_EQ(dot(cross(stance.right(), stance.up.vector()), stance.front.vector()), 1) << text(stance);
}

}  // namespace
}  // namespace affskel::core
