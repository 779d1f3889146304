#pragma once

#include <cstddef>
#include <cstdint>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// What the tests want to know of a mesh, found by counting alone, independently of the library.
struct MeshFacts {
  bool closed = false;             ///< every edge has exactly two triangles
  bool oriented = false;           ///< no edge is walked twice in the same direction
  bool vertices_manifold = false;  ///< the triangles round every vertex form one fan
  bool balanced = false;       ///< every edge is walked as often forth as back: a cycle, maybe not manifold
  std::size_t components = 0;  ///< of the triangles, joined over common vertices
  std::size_t unused_vertices = 0;
  std::int64_t euler = 0;  ///< used vertices - edges + triangles
  double volume = 0;       ///< signed
  double area = 0;
};

MeshFacts mesh_facts(const Mesh& mesh);

/// Expects a closed, oriented 2-manifold in one piece with outward triangles, no unused vertex and the
/// given genus.
void expect_solid_boundary(const Mesh& mesh, std::int64_t genus = 0);

/// Number of closed curves in which the plane z = `z` cuts a closed mesh that has no vertex at that height.
std::size_t section_curves(const Mesh& mesh, double z);

/// Winding number of a closed mesh about a point that is not on it: solid angles (van Oosterom & Strackee
/// 1983) over 4 pi.
double winding_number(const Mesh& mesh, const Vec3& q);

}  // namespace affskel::core
