#pragma once

#include <array>
#include <cstdint>

#include "core/base/matrix3.h"
#include "core/mesh/mesh.h"
#include "core/spatial/box_tree.h"

namespace affskel::core {

using Corners = std::array<Vec3, 3>;

/// The triangles of a mesh, multiplied by a power of two so that coordinates are at most 1.  That is exact,
/// and keeps squares within the range of a double.  Keeps a reference to the mesh.
class UnitTriangles {
 public:
  UnitTriangles() = default;  ///< of no mesh
  explicit UnitTriangles(const Mesh& mesh);

  Corners corners(std::uint32_t triangle) const {
    const Triangle& t = mesh_->triangles[triangle];
    return {unit_ * mesh_->points[t[0]], unit_ * mesh_->points[t[1]], unit_ * mesh_->points[t[2]]};
  }

  /// The factor from mesh units to these coordinates.
  double unit() const { return unit_; }

 private:
  const Mesh* mesh_ = nullptr;
  double unit_ = 1;
};

/// A box whose edges have any three directions at right angles to each other; coordinates are at most 1.
struct OrientedBox {
  Matrix3 axes = kIdentity3;  ///< orthonormal to rounding
  Vec3 centre;
  Vec3 half;  ///< half of its sides, along the axes
};

/// The tightest box along given axes.
class OrientedExtent {
 public:
  explicit OrientedExtent(const Matrix3& axes) : axes_(axes) {}
  void include(const Corners& corners);
  /// Of what was included, at least one triangle.
  OrientedBox box() const;

 private:
  Matrix3 axes_;
  Box along_;  // the axes
};

/// Along the triangle's longest side, and without thickness across its plane.
OrientedBox oriented_box(const Corners& corners);

/// The box as an oriented one, its coordinates multiplied by `unit`.
OrientedBox oriented_box(const Box& box, double unit);

/// Whether a plane parallel to a face of box `a` surely separates it from box `b`, whatever rounding did to
/// them.
bool surely_apart(const OrientedBox& a, const OrientedBox& b);

/// The same for a triangle.
bool surely_apart(const OrientedBox& box, const Corners& corners);

}  // namespace affskel::core
