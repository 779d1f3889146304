#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/mesh/box.h"
#include "core/shapes/surface_mesh.h"

namespace affskel::core {

/// Tells which collapses of edges would make a mesh cross itself: its triangles by the cells of a grid, kept up to date
/// from collapse to collapse.  Where the mesh did not cross itself before, and only what this allows is done, it never
/// does.
class CrossingGuard {
 public:
  /// @param surface a mesh of triangles that outlives this, not one of which is degenerate.
  /// @param triangles roughly as many as there will be.
  CrossingGuard(const SurfaceMesh& surface, std::size_t triangles);

  /// The vertex that an edge becomes, in the triangles of `star` below.
  std::uint32_t merged() const { return static_cast<std::uint32_t>(points_.size() - 1); }

  /// @param v, w ends of an edge that becomes a vertex at `place`. @param star the triangles round it.
  bool would_cross(std::uint32_t v, std::uint32_t w, const Vec3& place, std::span<const Triangle> star);

  /// An edge has become the vertex v.
  void collapsed(SurfaceMesh::Vertex_index v);

 private:
  template <class Body>
  void for_each_cell(const Box& box, const Body& body) const;
  Triangle corners(SurfaceMesh::Face_index face) const;
  Box box(const Triangle& t) const;
  void enter(SurfaceMesh::Face_index face);

  const SurfaceMesh& surface_;
  double edge_;  // of the cells
  std::vector<Vec3> points_;
  // Maybe among others that have gone from there.
  std::unordered_map<std::uint64_t, std::vector<SurfaceMesh::Face_index>> faces_;
};

}  // namespace affskel::core
