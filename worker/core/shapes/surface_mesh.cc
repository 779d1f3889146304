#include "core/shapes/surface_mesh.h"

#include <CGAL/boost/graph/iterator.h>

#include <vector>

#include "core/base/error.h"

namespace affskel::core {

SurfaceMesh surface_mesh_of(const Mesh& mesh) {
  SurfaceMesh surface;
  using Size = SurfaceMesh::size_type;
  surface.reserve(static_cast<Size>(mesh.points.size()), static_cast<Size>(mesh.triangles.size() * 3 / 2),
                  static_cast<Size>(mesh.triangles.size()));
  std::vector<SurfaceMesh::Vertex_index> vertices;
  vertices.reserve(mesh.points.size());
  for (const Vec3& p : mesh.points) vertices.push_back(surface.add_vertex(Point(p.x, p.y, p.z)));
  for (const Triangle& t : mesh.triangles) {
    if (surface.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]) == SurfaceMesh::null_face())
      throw CoreError(CoreError::Code::kBadInput, "the triangles are no manifold surface");
  }
  return surface;
}

Mesh mesh_of(const SurfaceMesh& surface) {
  Mesh mesh;
  std::vector<std::uint32_t> number(surface.num_vertices() + surface.number_of_removed_vertices());
  for (const SurfaceMesh::Vertex_index v : surface.vertices()) {
    number[v] = static_cast<std::uint32_t>(mesh.points.size());
    const Point& p = surface.point(v);
    mesh.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const SurfaceMesh::Face_index f : surface.faces()) {
    Triangle triangle{};
    std::size_t corner = 0;
    for (const SurfaceMesh::Vertex_index v : CGAL::vertices_around_face(surface.halfedge(f), surface))
      triangle[corner++] = number[v];
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace affskel::core
