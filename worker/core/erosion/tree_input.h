#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.h"
#include "core/erosion/join_tree.h"
#include "core/solid/solid.h"
#include "core/spatial/ray_shooter.h"

namespace affskel::core {

/// What TreeInput holds; for the sources of the join tree only.  Vertices and triangles are numbered anew, so
/// that neighbours are near in memory: every direction visits all of them.
struct TreeInput::Data {
  Data(const Solid& solid, unsigned threads);

  /// Triangles round a vertex.
  std::span<const std::uint32_t> fan(std::uint32_t vertex) const { return fans[vertex]; }

  std::vector<std::uint32_t> original_vertex;    ///< per vertex: its index in the solid's mesh
  std::vector<std::uint32_t> original_triangle;  ///< per triangle: its index in the solid's mesh
  Mesh mesh;                                     ///< the solid's, neighbours kept together in memory
  std::vector<Vec3> area_vector;                 ///< per triangle: outward normal times area, scaled units
  std::vector<Vec3> pseudonormal;  ///< per vertex: unit normals weighted by the angles they span
  Groups<std::uint32_t> fans;      ///< per vertex
  /// Whether a triangle round the vertex crosses another one.
  bool at_crossing(std::uint32_t vertex) const { return !crosses.empty() && crosses[vertex] != 0; }

  /// Triangles that cross a triangle; only where the surface crosses itself.
  std::span<const std::uint32_t> crossing(std::uint32_t triangle) const { return crossings[triangle]; }

  std::vector<std::uint32_t> vertex_solid;  ///< per vertex: the solid its surface bounds
  std::vector<std::uint8_t> crosses;        ///< per vertex; empty unless the surface crosses itself
  Groups<std::uint32_t> crossings;          ///< per triangle; likewise
  /// Per vertex: whether its outer side lies inside the solid because another surface winds round it; empty
  /// unless the surface crosses itself.
  std::vector<std::uint8_t> nested;
  std::vector<double> solid_volume;  ///< scaled units
  double volume = 0;                 ///< all solids, scaled units
  double surface_area = 0;           ///< scaled units
  RayShooter rays;

 private:
  void find_crossings(const Solid& solid);
  void find_nested(unsigned threads);
};

}  // namespace affskel::core
