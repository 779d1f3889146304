#pragma once

#include <string>

#include "core/base/matrix3.h"
#include "core/chords/chord_fields.h"
#include "core/curve/curve_graph.h"
#include "core/curve/curve_skeleton.h"
#include "core/mesh/mesh.h"
#include "core/ridge/ridge_sheet.h"

namespace affskel::core {

/// The curve skeletons of a solid that is eroded in a lattice of cubes.
class Curved {
 public:
  /// @param h their edge.
  Curved(const Mesh& mesh, double h, const std::string& directions)
      : Curved(mesh, {Vec3{h, 0, 0}, Vec3{0, h, 0}, Vec3{0, 0, h}}, directions) {}

  /// @param axes of its cells.
  Curved(const Mesh& mesh, const Matrix3& axes, const std::string& directions);

  CurveSkeleton at(double least_reach = CurveOptions().least_reach) const;

  /// Of the curve skeleton, in mesh units.
  CurveGraph graph(const CurveSkeleton& curve) const;

  /// Of a vertex, in the mesh's coordinates.
  Vec3 place(const SheetVertex& vertex) const { return solid_.place(vertex.position); }
  const RidgeSheet& ridge() const { return ridge_; }
  const ErodedSolid& solid() const { return solid_; }

 private:
  ErodedSolid solid_;
  RidgeBasis basis_;
  RidgeSheet ridge_;
};

}  // namespace affskel::core
