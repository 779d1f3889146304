#include "core/shapes/surface_mesh.h"

#include <CGAL/boost/graph/iterator.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/base/error.h"

namespace affskel::core {

namespace {

using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;

[[noreturn]] void no_manifold() {
  refuse("the triangles are no manifold surface");
}

std::uint64_t key_of(std::uint32_t from, std::uint32_t to) {
  return std::uint64_t(from) << 32 | to;
}

// Links the halfedges without a triangle to loops, each on to the next round its end.
void link_borders(SurfaceMesh& surface) {
  for (const Halfedge h : surface.halfedges()) {
    if (!surface.is_border(h)) continue;
    Halfedge next = surface.opposite(h);
    while (!surface.is_border(next)) next = surface.opposite(surface.prev(next));
    surface.set_next(h, next);
    surface.set_halfedge(surface.target(h), h);
  }
}

// Whether round a vertex inside the surface one comes to all that lead to it.
bool is_one_fan(const SurfaceMesh& surface, Vertex v, std::size_t leading) {
  const Halfedge first = surface.halfedge(v);
  if (!first.is_valid() || surface.is_border(first)) return true;
  std::size_t met = 0;
  Halfedge h = first;
  do {
    ++met;
    h = surface.opposite(surface.next(h));
  } while (h != first);
  return met == leading;
}

}  // namespace

// CGAL's add_face walks round a vertex for each of its triangles: the tip of a cone of 120,000 took a minute.
SurfaceMesh surface_mesh_of(const Mesh& mesh) {
  SurfaceMesh surface;
  using Size = SurfaceMesh::size_type;
  surface.reserve(static_cast<Size>(mesh.points.size()), static_cast<Size>(mesh.triangles.size() * 3 / 2),
                  static_cast<Size>(mesh.triangles.size()));
  for (const Vec3& p : mesh.points) surface.add_vertex(Point(p.x, p.y, p.z));
  std::unordered_map<std::uint64_t, Halfedge> sides;
  sides.reserve(3 * mesh.triangles.size());
  std::vector<std::size_t> leading(mesh.points.size(), 0);  // sides of triangles that lead to a vertex
  for (const Triangle& t : mesh.triangles) {
    const SurfaceMesh::Face_index face = surface.add_face();
    std::array<Halfedge, 3> round;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      if (from == to) no_manifold();
      const auto other = sides.find(key_of(to, from));
      round[k] =
          other == sides.end() ? surface.add_edge(Vertex(from), Vertex(to)) : surface.opposite(other->second);
      if (!sides.emplace(key_of(from, to), round[k]).second) no_manifold();
      surface.set_face(round[k], face);
      surface.set_halfedge(Vertex(to), round[k]);
      ++leading[to];
    }
    for (std::size_t k = 0; k < 3; ++k) surface.set_next(round[k], round[(k + 1) % 3]);
    surface.set_halfedge(face, round[2]);
  }
  link_borders(surface);
  for (const Vertex v : surface.vertices())
    if (!is_one_fan(surface, v, leading[v])) no_manifold();
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
