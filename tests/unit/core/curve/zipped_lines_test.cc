#include "core/curve/zipped_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "core/curve/drawn_lines.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

struct Strands : DrawnLines {
  std::vector<std::uint32_t> tips = {};

  SheetLines lines() const {
    SheetLines lines;
    for (std::uint32_t v = 0; v < places.size(); ++v) lines.vertices.push_back(v);
    lines.segments = segments;
    std::sort(lines.segments.begin(), lines.segments.end());
    return lines;
  }
  SheetLines zipped() {
    std::vector<char> ends(places.size(), 0);
    for (const std::uint32_t v : tips) ends[v] = 1;
    return zipped_lines(lines(), ends, ball, 0.1, places);
  }
};

// Places of the joints, by how many lines meet there.
std::multimap<std::size_t, Vec3> nodes(const Strands& strands, const SheetLines& lines) {
  std::vector<std::size_t> degree(lines.vertices.size(), 0);
  for (const Segment& segment : lines.segments)
    for (const std::uint32_t v : segment) ++degree[v];
  std::multimap<std::size_t, Vec3> result;
  for (std::size_t v = 0; v < degree.size(); ++v)
    if (degree[v] != 2) result.emplace(degree[v], strands.places[lines.vertices[v]]);
  return result;
}

std::int64_t euler(const SheetLines& lines) {
  return static_cast<std::int64_t>(lines.vertices.size()) - static_cast<std::int64_t>(lines.segments.size());
}

// A trunk of radius 1 along x, and two legs whose lines run in it from x = 0 to the hips at x = 4.
Strands body(double apart) {
  Strands body;
  const std::uint32_t joint = body.add({0, 0, 0}, 1);
  body.tips.push_back(body.go(joint, {-0.1, 0, 0}, 60, 1));
  body.tips.push_back(body.go(joint, {0.1, 0, 0}, 60, 1));
  for (const double side : {-1., 1.}) {
    const std::uint32_t hip = body.go(joint, {0.1, side * apart / 40, 0}, 40, 0.95);
    body.tips.push_back(body.go(hip, {0, side * 0.04, -0.1}, 60, 0.4));
  }
  return body;
}

TEST(ZippedLines, LegsLeaveTheSpineWhereTheyPartFromIt) {
  Strands strands = body(0.5);
  const SheetLines lines = strands.zipped();
  EXPECT_EQ(euler(lines), 1);
  const auto found = nodes(strands, lines);
  EXPECT_EQ(found.count(1), 4U);
  for (const auto& [degree, at] : found) {
    if (degree == 1) continue;
    EXPECT_NEAR(at.x, 4, 0.5);
    EXPECT_EQ(at.y, 0) << "the thinner line slides";
  }
}

// Lines in steps of the lattice: the first vertex of the spine lies back from the joint.
TEST(ZippedLines, AStepBackHidesNoneOfTheWay) {
  Strands strands = body(0.5);
  for (const auto& [a, b] : strands.segments)
    if (a == 0 && strands.places[b].x > 0 && strands.ball[b] == 1) strands.places[b] = {-0.02, 0, 0.1};
  const SheetLines lines = strands.zipped();
  for (const auto& [degree, at] : nodes(strands, lines)) {
    if (degree == 1) continue;
    EXPECT_NEAR(at.x, 4, 0.5);
  }
}

// Lines that leave a joint the opposite way are near each other as far as their balls reach, which may be larger than
// the joint's.
TEST(ZippedLines, OppositeOnesAreNotBesideEachOther) {
  Strands strands;
  const std::uint32_t joint = strands.add({0, 0, 0}, 1);
  for (const Vec3& way : {Vec3{0.1, 0, 0}, Vec3{-0.1, 0, 0}})
    strands.tips.push_back(strands.go(joint, way, 40, 1.5));
  strands.places[41].x = 0.05;  // a step back
  strands.tips.push_back(strands.go(joint, {0, 0, 0.1}, 40, 0.5));
  EXPECT_EQ(strands.zipped().segments, strands.lines().segments);
}

TEST(ZippedLines, WhatPartsWithinTheJointStays) {
  Strands strands = body(8);
  const SheetLines lines = strands.zipped();
  EXPECT_EQ(lines.segments, strands.lines().segments);
  EXPECT_EQ(lines.vertices, strands.lines().vertices);
}

// A jar's three strands from a place deep in its belly: to the neck, and to both handles, which lead there, too.
TEST(ZippedLines, HandlesKeepTheirTunnelsAndLeaveNoStub) {
  Strands jar;
  const std::uint32_t deep = jar.add({0, 0, 0}, 1);
  const std::uint32_t neck = jar.go(deep, {0, 0, 0.1}, 40, 1);
  for (const double side : {-1., 1.}) {
    const std::uint32_t shoulder = jar.go(deep, {side * 0.01, 0, 0.1}, 25, 0.9);
    const std::uint32_t out = jar.go(shoulder, {side * 0.1, 0, 0}, 25, 0.2);
    const std::uint32_t up = jar.go(out, {0, 0, 0.1}, 14, 0.2);
    const std::uint32_t last = jar.go(up, {side * -0.1, 0, 0}, 26, 0.2);
    jar.join(last, neck);
  }
  const SheetLines lines = jar.zipped();
  EXPECT_EQ(euler(lines), -1) << "two tunnels";
  const auto found = nodes(jar, lines);
  EXPECT_EQ(found.count(1), 0U);
  for (const auto& [degree, at] : found) EXPECT_GT(at.z, 1.5);
  EXPECT_EQ(jar.zipped().segments.size(), lines.segments.size()) << "the same again";
}

// A handle whose line comes back to the joint at the neck from deep in the belly, beside the jar's axis.
TEST(ZippedLines, ALoopSlidesAlongWhatItRunsBeside) {
  Strands jar;
  const std::uint32_t neck = jar.add({0, 0, 4}, 0.8);
  jar.tips.push_back(jar.go(neck, {0, 0, -0.1}, 80, 1));
  const std::uint32_t out = jar.go(neck, {0.1, 0, 0}, 25, 0.2);
  const std::uint32_t down = jar.go(out, {0, 0, -0.1}, 30, 0.2);
  const std::uint32_t deep = jar.go(down, {-0.1, 0, 0}, 24, 0.9);
  jar.join(jar.go(deep, {-0.002, 0, 0.1}, 29, 0.95), neck);
  const SheetLines lines = jar.zipped();
  EXPECT_EQ(euler(lines), 0) << "one tunnel";
  const auto found = nodes(jar, lines);
  EXPECT_EQ(found.count(1), 1U);
  ASSERT_EQ(found.count(3), 1U);
  EXPECT_NEAR(found.find(3)->second.z, 1, 0.2);
}

// Two lines between the same joints enclose a tunnel of the lattice, however near they lie: it stays.
TEST(ZippedLines, ALoopIsNotClosed) {
  Strands loop;
  const std::uint32_t low = loop.add({0, 0, 0}, 1);
  const std::uint32_t high = loop.go(low, {0, 0, 0.1}, 40, 1);
  const std::uint32_t beside = loop.go(loop.go(low, {0.2, 0, 0.1}, 1, 0.9), {0, 0, 0.1}, 38, 0.9);
  loop.join(beside, high);
  loop.tips.push_back(loop.go(low, {0, 0, -0.1}, 20, 1));
  loop.tips.push_back(loop.go(high, {0, 0, 0.1}, 20, 1));
  const SheetLines lines = loop.zipped();
  EXPECT_EQ(euler(lines), 0);
  EXPECT_EQ(polylines(lines.vertices.size(), lines.segments).size(), 4U);
  std::vector<Segment> once = lines.segments;
  once.erase(std::unique(once.begin(), once.end()), once.end());
  EXPECT_EQ(once.size(), lines.segments.size());
}

}  // namespace
}  // namespace affskel::core
