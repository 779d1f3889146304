#include "core/curve/curved.h"

#include <vector>

namespace affskel::core {

Curved::Curved(const Mesh& mesh, const Matrix3& axes, const std::string& directions)
    : solid_(mesh, axes, directions),
      basis_(ridge_basis(solid_.solid, solid_.lattice, solid_.field)),
      ridge_(ridge_sheet(solid_.solid, solid_.lattice, solid_.field, basis_)) {}

CurveSkeleton Curved::at(double least_reach) const {
  CurveOptions options;
  options.least_reach = least_reach;
  const LimbSurface surface = limb_surface(solid_.solid, solid_.lattice);
  return curve_skeleton({solid_.solid, solid_.lattice, basis_, ridge_, surface}, options);
}

CurveGraph Curved::graph(const CurveSkeleton& curve) const {
  std::vector<Vec3> places;
  for (const SheetVertex& vertex : curve.vertices) places.push_back(place(vertex));
  return curve_graph(places, curve.segments, curve.radius, curve.share);
}

}  // namespace affskel::core
