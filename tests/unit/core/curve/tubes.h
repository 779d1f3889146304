#pragma once

#include <functional>
#include <span>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// What lies within `radius` of a segment: a tube with round ends, which has known measures.
struct Tube {
  Vec3 from, to;
  double radius = 0;

  bool contains(const Vec3& p) const { return distance(p) <= 0; }
  double distance(const Vec3& p) const;  ///< to its surface, < 0 within
};

/// The tubes as one solid, by marching tetrahedra of edges about `edge`.
Mesh tube_mesh(std::span<const Tube> tubes, double edge);

/// Volume of a tube's places where something holds, counted on a fine lattice: a few parts in ten thousand.
double volume_where(const Tube& tube, const std::function<bool(const Vec3&)>& where);

/// The place turned about two axes, so that no tube lies along the lattice.
Vec3 turned(const Vec3& p);

}  // namespace affskel::core
