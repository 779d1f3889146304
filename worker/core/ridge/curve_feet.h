#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/contour/sheet_mesh.h"
#include "core/ridge/ridge_curves.h"

namespace affskel::core {

constexpr std::uint32_t kNoVertex = 0xFFFFFFFFU;

/// A vertex of ridge curves; those of all curves are numbered on.
struct CurveVertex {
  Vec3 position;
  double radius = 0;
  double arc = 0;                       ///< length from the curve's first vertex
  std::uint32_t stretch = 0, part = 0;  ///< which curve; of the solid
  Vec3 outward;                         ///< at an end of the curve: unit, away from it; else 0
};

/// The vertices of all curves, in their order.
std::vector<CurveVertex> curve_vertices(std::span<const RidgeCurve> curves);

/// Where a vertex of the sheet lies beside the curves.
struct CurveFoot {
  enum class Place : char { kFar, kBeyondEnd, kBeside } place = Place::kFar;
  std::uint32_t vertex = kNoVertex;  ///< the nearest of the curves in the same part, where within its reach
  bool sideways = false;             ///< beyond the reach, but not beyond an end
};

/// The feet of the vertices of a sheet on curves.  Exact; ties go to the curve vertex of the lower number.
/// @param reach in the radius of the section at the foot.
/// @return per vertex of the mesh.
std::vector<CurveFoot> curve_feet(const SheetMesh& mesh, const std::vector<CurveVertex>& curves,
                                  double reach);

/// Whether the corners of a triangle all lie beside one and the same curve, within the reach.
bool is_beside(const std::vector<CurveFoot>& feet, const std::vector<CurveVertex>& curves,
               const Triangle& triangle);

}  // namespace affskel::core
