#pragma once

#include <cstdint>

#include "core/mesh/mesh.h"

namespace affskel::core {

struct MakeBodyOptions {
  std::uint32_t triangles = 500;  ///< exactly this many; even, 200 .. 200000
  double height = 1800;           ///< from sole to crown, in mesh units, > 0
};

/// A standing humanoid of our own, facing -y, z up, soles at z = 0: a smooth implicit union of limbs
/// (torso, head, arms held away from it, legs, feet), meshed by CGAL and reduced to exactly
/// `options.triangles` triangles.  Closed, manifold, outward, genus 0, not self-intersecting.
/// @throws CoreError kBadInput when an option is out of range.
Mesh make_body(const MakeBodyOptions& options = {});

}  // namespace affskel::core
