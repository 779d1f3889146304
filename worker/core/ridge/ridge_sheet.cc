#include "core/ridge/ridge_sheet.h"

#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/contour/dual_contour.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/solid_parts.h"
#include "core/ridge/ridge_crossings.h"
#include "core/ridge/ridge_curves.h"
#include "core/ridge/ridge_flaps.h"
#include "core/ridge/ridge_holes.h"
#include "core/ridge/ridge_joins.h"
#include "core/ridge/ridge_values.h"
#include "core/ridge/round_sheet.h"
#include "core/ridge/round_stretches.h"
#include "core/ridge/torn_strips.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

// A vertex has the mean of its cell's crossings, normals turned to agree with the first.
SheetMesh contour(const Lattice& lattice, const SolidParts& parts, std::span<const RidgeCrossing> crossings,
                  ExecutionContext* context) {
  std::vector<SheetCrossing> places;
  places.reserve(crossings.size());
  for (const RidgeCrossing& crossing : crossings)
    places.push_back({crossing.edge, crossing.at.position, crossing.normal});
  const auto mean = [&](const Vec3&, std::span<const std::uint32_t> members) {
    SheetVertex vertex = crossings[members[0]].at;
    for (std::size_t n = 1; n < members.size(); ++n)
      vertex = between(vertex, crossings[members[n]].at, 1 / static_cast<double>(n + 1));
    return vertex;
  };
  return dual_contour(lattice, parts, places, mean, context);
}

}  // namespace

RidgeSheet ridge_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const RidgeSheetOptions& options, const RidgeConstants& constants) {
  if (!options.known_derivatives.empty() && options.known_derivatives.size() != lattice.points)
    throw CoreError(CoreError::Code::kBadInput, "the known derivatives are not those of this lattice");
  const SolidParts parts(solid, lattice);
  std::vector<RidgeCrossing> crossings;
  std::vector<RidgeCurve> curves;
  {
    std::vector<PointDerivatives> computed;
    if (options.known_derivatives.empty())
      computed = smoothed_derivatives(lattice, field, options.context, constants);
    const RidgeValues values(lattice, parts, field, computed.empty() ? options.known_derivatives : computed,
                             constants.weak_share * options.bounds.low, constants.min_erosion);
    crossings = ridge_crossings(lattice, values);
    throw_if_stopped(options.context);
    curves = ridge_curves(lattice, parts, values, options.context);
  }
  throw_if_stopped(options.context);
  SheetMesh mesh = contour(lattice, parts, crossings, options.context);
  throw_if_stopped(options.context);
  RidgeSheet sheet;
  sheet.pieces = cut_rims(mesh, options.bounds, constants);
  sheet.flaps_cut = cut_flaps(mesh, constants.max_flap);
  const SolidMembership membership(solid.mesh);
  const auto inside = [&](const Vec3& u) {
    return membership.contains(scaled_place(lattice, (1 / lattice.spacing) * u));
  };
  sheet.holes_closed = close_holes(mesh, inside, constants.max_hole);
  const std::vector<RidgeCurve> round = round_stretches(curves, options.bounds, constants);
  sheet.curves = put_curves(mesh, torn_stretches(mesh, round, constants), inside, constants);
  sheet.pieces.bridges += join_pieces(mesh, lattice, field, inside, constants.max_join);
  static_cast<SheetMesh&>(sheet) = std::move(mesh);
  return sheet;
}

}  // namespace affskel::core
