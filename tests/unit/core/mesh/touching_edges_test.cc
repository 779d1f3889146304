#include "core/mesh/touching_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/mesh/mesh_topology.h"
#include "core/solid/solid.h"

namespace affskel::core {
namespace {

// Wedges about the edge from (0, 0, 0) to (0, 0, 1), each between two angles: vertices 0 and 1 are the edge's.
Mesh wedges(const std::vector<std::pair<double, double>>& angles) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 1}};
  for (const auto& [from, to] : angles) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (const double angle : {from, to}) mesh.points.push_back({std::cos(angle), std::sin(angle), 0.5});
    const std::uint32_t a = first, b = first + 1;
    for (const Triangle& t : {Triangle{0, a, 1}, Triangle{0, 1, b}, Triangle{0, b, a}, Triangle{1, a, b}})
      mesh.triangles.push_back(t);
  }
  return mesh;
}

Mesh reversed(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

double volume_of_wedge(double from, double to) {
  return std::sin(to - from) / 6;
}

TEST(TouchingEdges, PartsAreApart) {
  const std::vector<std::pair<double, double>> angles = {
      {-3.1, -2}, {-1, 0.1}, {0.1, 0.9}, {1.2, 1.2001}, {2.5, 3.1}};
  double volume = 0;
  for (const auto& [from, to] : angles) volume += volume_of_wedge(from, to);
  for (const bool inside_out : {false, true}) {
    const Mesh mesh = inside_out ? reversed(wedges(angles)) : wedges(angles);
    EXPECT_EQ(enclosed_volume(mesh) < 0, inside_out);
    Mesh apart = mesh;
    EXPECT_EQ(separate_touching_edges(apart), 2 * (angles.size() - 1));
    const Solid solid = make_solid(apart);
    EXPECT_EQ(solid.solid_volume.size(), angles.size());
    EXPECT_NEAR(solid.volume, volume, 1e-12);
    HalfEdges mates;
    EXPECT_TRUE(find_mates_if_closed(apart, 1, mates));
    std::uint32_t parts = 0;
    connected_surfaces(mates, parts);
    EXPECT_EQ(parts, angles.size());
  }
}

// Whatever the direction of the edge, and wherever the angles begin.
TEST(TouchingEdges, TurnedAsOneLikes) {
  for (int n = 0; n < 12; ++n) {
    const double turn = n * std::numbers::pi / 6;
    Mesh mesh = wedges({{turn, turn + 1}, {turn + 1, turn + 2}, {turn + 3, turn + 4}});
    for (Vec3& p : mesh.points) p = {p.z + 0.3 * n * p.y, p.x, p.y};
    if (enclosed_volume(mesh) < 0) mesh = reversed(mesh);
    separate_touching_edges(mesh);
    EXPECT_EQ(make_solid(mesh).solid_volume.size(), 3U) << n;
  }
}

// A book of leaves that do not alternate is no boundary.
TEST(TouchingEdges, WhatCannotBeToldStays) {
  Mesh mesh = wedges({{0, 1}, {2, 3}});
  mesh.triangles.pop_back();  // an open edge elsewhere
  Mesh opened = mesh;
  EXPECT_EQ(separate_touching_edges(opened), 2U);
  Mesh three = wedges({{0, 1}, {2, 3}});
  three.triangles.push_back({0, 1, 2});  // a third leaf
  const Mesh before = three;
  EXPECT_EQ(separate_touching_edges(three), 0U);
  EXPECT_EQ(three.triangles, before.triangles);
  EXPECT_TRUE(
      mate_across_solid(three, Edges(three.points.size(), three.triangles).between(0, 1), false).empty());
}

}  // namespace
}  // namespace affskel::core
