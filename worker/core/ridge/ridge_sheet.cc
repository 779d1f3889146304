#include "core/ridge/ridge_sheet.h"

#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/require.h"
#include "core/contour/dual_contour.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/solid_parts.h"
#include "core/ridge/ridge_crossings.h"
#include "core/ridge/ridge_curves.h"
#include "core/ridge/ridge_values.h"
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

std::vector<PointDerivatives> derivatives_of(const Lattice& lattice, const FrameField& field,
                                             const RidgeSheetOptions& options) {
  SmoothedDerivativesOptions smoothing = options.derivatives;
  smoothing.context = options.context;
  std::vector<PointDerivatives> result = smoothed_derivatives(lattice, field, smoothing);
  throw_if_stopped(options.context);
  return result;
}

}  // namespace

RidgeSheet ridge_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const RidgeSheetOptions& options) {
  require_within(options.weak_share, 1e-3, 1, "the share of the weak sheet must lie between 0.001 and 1");
  if (!options.known_derivatives.empty() && options.known_derivatives.size() != lattice.points)
    throw CoreError(CoreError::Code::kBadInput, "the known derivatives are not those of this lattice");
  const SolidParts parts(solid, lattice);
  std::vector<RidgeCrossing> crossings;
  std::vector<RidgeCurve> curves;
  {
    std::vector<PointDerivatives> computed;
    if (options.known_derivatives.empty()) computed = derivatives_of(lattice, field, options);
    const RidgeValues values(lattice, parts, field, computed.empty() ? options.known_derivatives : computed,
                             options.weak_share * options.rims.low, options.min_erosion);
    crossings = ridge_crossings(lattice, values);
    throw_if_stopped(options.context);
    curves = ridge_curves(lattice, parts, values, options.context);
  }
  throw_if_stopped(options.context);
  SheetMesh mesh = contour(lattice, parts, crossings, options.context);
  throw_if_stopped(options.context);
  RidgeSheet sheet;
  sheet.pieces = cut_rims(mesh, options.rims);
  sheet.flaps_cut = cut_flaps(mesh, options.flaps);
  const SolidMembership membership(solid.mesh);
  const auto inside = [&](const Vec3& u) {
    return membership.contains(scaled_place(lattice, (1 / lattice.spacing) * u));
  };
  sheet.holes_closed = close_holes(mesh, inside, options.holes);
  RoundStretchOptions round = options.round;
  round.low_strength = options.rims.low;
  round.high_strength = options.rims.high;
  round.max_roundness = options.rims.max_roundness;
  TornStripOptions torn = options.torn;
  torn.reach = options.round_sheet.reach;
  torn.round_ratio = options.round_sheet.round_ratio;
  const std::vector<RidgeCurve> stretches = torn_stretches(mesh, round_stretches(curves, round), torn);
  sheet.curves = put_curves(mesh, stretches, inside, options.round_sheet);
  sheet.pieces.bridges += join_pieces(mesh, lattice, field, inside, options.joins);
  static_cast<SheetMesh&>(sheet) = std::move(mesh);
  return sheet;
}

}  // namespace affskel::core
