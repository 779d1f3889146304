#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct RidgeVertex {
  Vec3 position;            ///< frame coordinates
  std::uint32_t point = 0;  ///< rank of a sample point next to it
  double erosion = 0;       ///< E, volume
  double strength = 0;      ///< s, radians, see ridge_crossings(); on a curve s_2, see ridge_curves()
  double ratio = 0;         ///< lambda_2 / lambda_1, see ridge_crossings()
  double roundness = 0;     ///< lambda_3 / lambda_1, see ridge_crossings()
  double area = 0;          ///< of the section through the vertex, mesh units squared
  Vec3 normal_a, normal_b;  ///< unit normals of the level surfaces on the two sides, frame coordinates;
                            ///< normal_a - normal_b points from a's side of the sheet to b's
};

/// A sheet of triangles without a common orientation, with rims and branches, and curves.
struct RidgeMesh {
  std::vector<RidgeVertex> vertices;
  std::vector<std::uint32_t> part;  ///< per vertex: of the solid
  std::vector<Triangle> triangles;
  std::vector<Segment> segments;  ///< of curves: two vertices each
};

/// a + t (b - a), all values; normals are turned to agree and made unit again.
RidgeVertex between(const RidgeVertex& a, const RidgeVertex& b, double t);

/// The area of a triangle of the mesh.
double triangle_area(const RidgeMesh& mesh, const Triangle& triangle);

/// Leaves out the vertices that neither triangle nor segment uses; the others keep their order.
void drop_unused_vertices(RidgeMesh& mesh);

}  // namespace affskel::core
