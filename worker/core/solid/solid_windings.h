#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// Tells loops within a solid that go round nothing from those that go through its tunnels.  A loop in the solid bounds
/// a surface there just when it is linked with no loop on the solid's boundary (Alexander duality), and the loops of
/// surface_loops() stand for all of these.  Linking numbers are Gauss's integral, over straight ways in closed form.
class SolidWindings {
 public:
  /// @param boundary of the solid, closed and manifold.
  explicit SolidWindings(const Mesh& boundary);

  /// How many loops the boundary has: twice its genus.
  std::size_t size() const { return loops_.size(); }

  /// The share that a straight way in the solid has in the linking number with each loop.  Over closed ways they sum up
  /// to integers.  O(edges of the loops)
  std::vector<double> along(const Vec3& from, const Vec3& to) const;

 private:
  std::vector<std::vector<Vec3>> loops_;
};

}  // namespace affskel::core
