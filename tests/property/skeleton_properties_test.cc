// What every curve skeleton must satisfy, on random solids.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/chords/chord_fields.h"
#include "core/curve/curve_skeleton.h"
#include "core/quality/sheet_topology.h"
#include "core/ridge/ridge_sheet.h"
#include "core/shapes/implicit_mesh.h"
#include "core/solid/betti_numbers.h"
#include "drawn_solids.h"

namespace affskel::property {
namespace {

using core::BettiNumbers;
using core::Mesh;
using core::Vec3;

double draw_within(double low, double high) {
  return low + (high - low) * draw_in(0, 1001) / 1000.0;
}

Vec3 draw_place(double most) {
  return {draw_within(-most, most), draw_within(-most, most), draw_within(-most, most)};
}

// A tube along a line, or bent to a ring.
struct Tube {
  Vec3 from, to;  // of a ring its centre, and its axis from there
  double major = 0, minor = 0;

  double distance(const Vec3& p) const {
    const Vec3 way = to - from;
    const double t = dot(p - from, way) / dot(way, way);
    if (major == 0) return norm(p - from - std::clamp(t, 0.0, 1.0) * way) - minor;
    return std::hypot(norm(p - from - t * way) - major, t * norm(way)) - minor;
  }
};

Tube draw_tube() {
  Tube tube{draw_place(0.8), {}, 0, draw_within(0.18, 0.4)};
  Vec3 way = draw_place(1);
  if (norm(way) < 0.2) way = {0, 0, 1};
  tube.to = tube.from + way;
  if (draw_in(0, 3) == 0) tube.major = draw_within(tube.minor + 0.15, 1);
  return tube;
}

constexpr double kSpacing = 0.1;

// What is nearer to the tubes than `offset`; joined smoothly.
Mesh mesh_of(const std::vector<Tube>& tubes, double offset) {
  constexpr double kEdge = 0.12, kBlend = 0.1;
  const auto inside = [&](const Vec3& p) {
    double least = tubes[0].distance(p);
    for (std::size_t n = 1; n < tubes.size(); ++n) {
      const double other = tubes[n].distance(p);
      const double near = std::max(kBlend - std::abs(least - other), 0.0) / kBlend;
      least = std::min(least, other) - 0.25 * kBlend * near * near;
    }
    return least - offset;
  };
  Mesh mesh = core::mesh_zero_set(inside, {{-3, -3, -3}, {3, 3, 3}, kEdge});
  core::fair_onto(inside, 0.01 * kEdge, 2, mesh);
  return mesh;
}

// Trees, handles, links, several pieces, whose topology is the same for offsets of a spacing: no neck and no gap is so
// thin that the lattice may not show it.
Mesh draw_tubes() {
  while (true) {
    std::vector<Tube> tubes(draw_in(1U, 6U));
    for (Tube& tube : tubes) tube = draw_tube();
    const core::Solid solid = core::make_solid(mesh_of(tubes, 0));
    const BettiNumbers betti = core::betti_numbers(solid);
    if (solid.self_intersecting) continue;
    if (core::betti_numbers(core::make_solid(mesh_of(tubes, -kSpacing))) != betti) continue;
    if (core::betti_numbers(core::make_solid(mesh_of(tubes, kSpacing))) != betti) continue;
    return mesh_of(tubes, 0);
  }
}

core::CurveSkeleton curve_of(const core::ErodedSolid& eroded, BettiNumbers& lattice) {
  const core::RidgeBasis basis = core::ridge_basis(eroded.lattice, eroded.field);
  core::RidgeSheetOptions options;
  options.basis = &basis;
  const core::RidgeSheet ridge = core::ridge_sheet(eroded.solid, eroded.lattice, eroded.field, options);
  lattice = ridge.lattice;
  return core::curve_skeleton(eroded.solid, eroded.lattice, basis, ridge);
}

RC_GTEST_PROP(CurveProperties, PiecesAndTunnelsAreTheSolids, ()) {
  const core::ErodedSolid eroded(
      draw_tubes(), {Vec3{kSpacing, 0, 0}, Vec3{0, kSpacing, 0}, Vec3{0, 0, kSpacing}}, "sphere:80");
  const BettiNumbers solid = core::betti_numbers(eroded.solid);
  BettiNumbers lattice;
  const core::CurveSkeleton curve = curve_of(eroded, lattice);
  const BettiNumbers found = core::sheet_topology(core::mesh_of(curve), curve.segments).betti;
  RC_ASSERT(found.components == solid.components);
  RC_ASSERT(found.holes == solid.holes);
  RC_ASSERT(found.cavities == 0U);
}

}  // namespace
}  // namespace affskel::property
