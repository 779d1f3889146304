#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// What a part of a skeleton is: ridge surface, or curve, of E; or what the solid's own topology adds to
/// them, lines (ways) and surfaces (membranes).
enum class SkeletonKind : std::uint8_t { kRidge, kCurve, kMembrane, kWay };

/// A vertex of the skeleton of `chords` or `ridge`.
struct SheetVertex {
  Vec3 position;            ///< frame coordinates, in the solid
  double erosion = 0;       ///< E, volume
  double strength = 0;      ///< of `chords` the mean r of the cell's shocks; of `ridge` s, radians, see
                            ///< ridge_crossings(), on a curve s_2, see ridge_curves(), else 0
  double area = 0;          ///< of the sections through the vertex, mean, mesh units squared
  Vec3 normal_a, normal_b;  ///< unit normals of the level surfaces on the two sides, frame coordinates;
                            ///< normal_a - normal_b points from a's side of the sheet to b's
  std::uint32_t point = 0;  ///< of `ridge`: rank of a sample point next to it
  double ratio = 0;         ///< of `ridge`: lambda_2 / lambda_1, see ridge_crossings()
  double roundness = 0;     ///< of `ridge`: lambda_3 / lambda_1, see ridge_crossings()
  SkeletonKind kind = SkeletonKind::kRidge;
  bool turns = false;  ///< of `chords`: no strict shock is near, see ChordShock::turns
};

/// A sheet of triangles, which may have one side only, with rims and branches, and curves.
struct SheetMesh {
  std::vector<SheetVertex> vertices;
  std::vector<std::uint32_t> part;  ///< per vertex: of the solid
  std::vector<Triangle> triangles;
  std::vector<Segment> segments;  ///< of curves: two vertices each
};

/// Of the vertices.
std::vector<Vec3> positions(const SheetMesh& sheet);

/// Points and triangles alone.
Mesh mesh_of(const SheetMesh& sheet);

/// a + t (b - a), all values but the strength, which is above 0: it grows without bound where the gradient vanishes, and
/// 1 / strength goes evenly.  Normals are turned to agree and made unit again.
SheetVertex between(const SheetVertex& a, const SheetVertex& b, double t);

}  // namespace affskel::core
