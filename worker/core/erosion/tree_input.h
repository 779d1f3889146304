#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.h"
#include "core/solid/solid.h"
#include "core/spatial/ray_shooter.h"

namespace affskel::core {

/// What the join trees of all directions of a solid share: area vectors, fans, a tree of boxes for rays, and a copy of the
/// mesh, whose vertices and triangles are numbered anew, so that neighbours are near in memory: every direction visits
/// all of them.  Immutable; threads share it.
struct TreeInput {
  /// Computed on up to `threads` threads.
  explicit TreeInput(const Solid& solid, unsigned threads = 1);
  TreeInput(const TreeInput&) = delete;
  TreeInput& operator=(const TreeInput&) = delete;

  /// Triangles and edges that rise less than this (scaled units) count as level.
  static constexpr double kLevelHeight = 1e-11;

  /// Largest error of a computed volume, and the most by which it may fall along a run, scaled units: 1e-9 v0
  /// and kLevelHeight times the surface (which includes the rounding of heights to 2^-44).
  double volume_tolerance() const { return 1e-9 * volume + kLevelHeight * surface_area; }

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
