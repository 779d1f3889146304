#pragma once

#include <cstdint>
#include <vector>

#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// The parts of a solid that have an E of their own: its connected solids, those whose surfaces pass through
/// each other taken as one.  A solid in a cavity of another is a part, and so are solids that only touch.
/// Numbered by their first shell.  Keeps references to solid and lattice.
class SolidParts {
 public:
  /// O(N + runs).
  SolidParts(const Solid& solid, const Lattice& lattice);

  std::uint32_t count() const { return count_; }

  /// The part that a sample point lies in: that of the surface where the point's line enters the solid.
  /// O(log runs), O(1) in a solid of one part.
  std::uint32_t of_point(std::uint32_t point) const;

  /// Sample points of a part.
  std::uint32_t points(std::uint32_t part) const { return points_[part]; }

  /// Each part's surface, scaled coordinates; the triangles in the order of the solid's mesh.
  std::vector<Mesh> meshes() const;

 private:
  std::uint32_t of_triangle(std::uint32_t triangle) const {
    return part_of_solid_[solid_.solid_of(triangle)];
  }

  const Solid& solid_;
  const Lattice& lattice_;
  std::vector<std::uint32_t> part_of_solid_, points_;
  std::uint32_t count_ = 0;
};

}  // namespace affskel::core
