// What every skeleton of `ridge` and `curve` must satisfy, on random solids.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/unit.h"
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
using Distance = core::ImplicitFunction;

double draw_within(double low, double high) {
  return low + (high - low) * draw_in(0, 1001) / 1000.0;
}

Vec3 draw_place(double most) {
  return {draw_within(-most, most), draw_within(-most, most), draw_within(-most, most)};
}

Vec3 draw_way() {
  const Vec3 way = draw_place(1);
  return norm(way) < 0.2 ? Vec3{0, 0, 1} : way;
}

Distance ball(const Vec3& centre, double radius) {
  return [=](const Vec3& p) { return norm(p - centre) - radius; };
}

Distance ring(const Vec3& centre, const Vec3& axis, double major, double minor) {
  return [=, n = core::unit(axis)](const Vec3& p) {
    const double along = dot(p - centre, n);
    return std::hypot(norm(p - centre - along * n) - major, along) - minor;
  };
}

Distance draw_tube() {
  return [from = draw_place(0.8), way = draw_way(), radius = draw_within(0.18, 0.4)](const Vec3& p) {
    const double t = dot(p - from, way) / dot(way, way);
    return norm(p - from - std::clamp(t, 0.0, 1.0) * way) - radius;
  };
}

Distance draw_ring() {
  const double minor = draw_within(0.18, 0.4);
  return ring(draw_place(0.8), draw_way(), draw_within(minor + 0.15, 1), minor);
}

Distance draw_box() {
  const Vec3 centre = draw_place(0.8), x = core::unit(draw_way()),
             y = core::unit(cross(x, std::abs(x.z) < 0.7 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
  const std::array<Vec3, 3> axes{x, y, cross(x, y)};
  const std::array<double, 3> half{draw_within(0.2, 0.8), draw_within(0.2, 0.8), draw_within(0.2, 0.8)};
  return [=](const Vec3& p) {
    double outside = 0, inside = -HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k) {
      const double beyond = std::abs(dot(p - centre, axes[k])) - half[k];
      outside = std::hypot(outside, std::max(beyond, 0.0));
      inside = std::max(inside, beyond);
    }
    return outside + std::min(inside, 0.0);
  };
}

// What is in a part and in none of the carved ones.
struct Union {
  std::vector<Distance> parts, carved;
};

Union draw_union() {
  Union drawn;
  if (draw_in(0, 3) == 0) {  // a hollow ball, or one with a hollow ring
    const Vec3 centre = draw_place(0.5);
    const double radius = draw_within(0.6, 1.1), hollow = draw_within(0.2, radius - 0.35);
    drawn.parts.push_back(ball(centre, radius));
    if (radius > 0.95 && draw_in(0, 2) == 0)
      drawn.carved.push_back(ring(centre, draw_way(), 0.48, 0.2));
    else
      drawn.carved.push_back(ball(centre, hollow));
  }
  for (int left = draw_in(1, 6); left > 0; --left) {
    switch (draw_in(0, 6)) {
      case 0:
        drawn.parts.push_back(ball(draw_place(0.8), draw_within(0.3, 0.8)));
        break;
      case 1:
        drawn.parts.push_back(draw_box());
        break;
      case 2:
      case 3:
        drawn.parts.push_back(draw_ring());
        break;
      default:
        drawn.parts.push_back(draw_tube());
        break;
    }
  }
  return drawn;
}

// What is nearer to it than `offset`; parts are joined smoothly.
Mesh mesh_of(const Union& drawn, double offset) {
  constexpr double kEdge = 0.12, kBlend = 0.1;
  const auto inside = [&](const Vec3& p) {
    double least = drawn.parts[0](p);
    for (std::size_t n = 1; n < drawn.parts.size(); ++n) {
      const double other = drawn.parts[n](p);
      const double near = std::max(kBlend - std::abs(least - other), 0.0) / kBlend;
      least = std::min(least, other) - 0.25 * kBlend * near * near;
    }
    for (const Distance& carved : drawn.carved) least = std::max(least, -carved(p));
    return least - offset;
  };
  Mesh mesh = core::mesh_zero_set(inside, {{-3, -3, -3}, {3, 3, 3}, kEdge});
  core::fair_onto(inside, 0.01 * kEdge, 2, mesh);
  return mesh;
}

core::ErodedSolid eroded_of(const Mesh& mesh, double h) {
  return {mesh, {Vec3{h, 0, 0}, Vec3{0, h, 0}, Vec3{0, 0, h}}, "sphere:80"};
}

// Trees, handles, links, cavities, several pieces, whose topology is the same for offsets up to a spacing: no neck, no
// wall and no gap is so thin that the lattice may not show it.  In short steps, lest one tunnel open as another closes.
Mesh draw_resolved(double spacing) {
  while (true) {
    const Union drawn = draw_union();
    const Mesh mesh = mesh_of(drawn, 0);
    const core::Solid solid = core::make_solid(mesh);
    if (solid.self_intersecting) continue;
    const BettiNumbers betti = core::betti_numbers(solid);
    const auto stays = [&](double share) {
      const Mesh moved = mesh_of(drawn, share * spacing);
      return core::betti_numbers(core::make_solid(moved, {.check_self_intersections = false})) == betti;
    };
    if (stays(-1) && stays(1) && stays(-0.5) && stays(0.5)) return mesh;
  }
}

// Pieces, tunnels and voids, as rapidcheck shows them.
using Topology = std::array<std::uint64_t, 3>;

Topology topology(const BettiNumbers& betti) {
  return {betti.components, betti.holes, betti.cavities};
}

Topology topology(const core::SheetMesh& skeleton) {
  return topology(core::sheet_betti_numbers(core::mesh_of(skeleton), skeleton.segments));
}

core::RidgeSheet ridge_of(const core::ErodedSolid& eroded, const core::RidgeBasis& basis) {
  return core::ridge_sheet(eroded.solid, eroded.lattice, eroded.field, basis);
}

RC_GTEST_PROP(SkeletonProperties, TopologyIsTheSolids, ()) {
  constexpr double kSpacing = 0.1;
  const core::ErodedSolid eroded = eroded_of(draw_resolved(kSpacing), kSpacing);
  const Topology solid = topology(core::betti_numbers(eroded.solid));
  const core::RidgeBasis basis = core::ridge_basis(eroded.solid, eroded.lattice, eroded.field);
  // Offsets of blends are no distances: one tunnel in some thousands is narrower than they say.
  RC_PRE(topology(basis.topology) == solid);
  const core::RidgeSheet ridge = ridge_of(eroded, basis);
  RC_ASSERT(topology(ridge) == solid);
  const Topology curve = topology(core::curve_skeleton(
      {eroded.solid, eroded.lattice, basis, ridge, core::limb_surface(eroded.solid, eroded.lattice)}));
  RC_ASSERT(curve == (Topology{solid[0], solid[1], 0}));
}

// On lattices too coarse for the solid, too.
RC_GTEST_PROP(SkeletonProperties, RidgeHasTheTopologyOfTheLattice, ()) {
  const core::ErodedSolid eroded = eroded_of(mesh_of(draw_union(), 0), 0.2);
  const core::RidgeBasis basis = core::ridge_basis(eroded.solid, eroded.lattice, eroded.field);
  const core::RidgeSheet ridge = ridge_of(eroded, basis);
  Topology expected = topology(ridge.lattice);
  expected[0] -= ridge.fragments;
  RC_ASSERT(topology(ridge) == expected);
  if (eroded.solid.self_intersecting) return;  // what noise has bored is filled
  expected = topology(basis.topology);
  expected[1] -= ridge.filled.edges.size();
  RC_ASSERT(topology(ridge.lattice) == expected);
}

}  // namespace
}  // namespace affskel::property
