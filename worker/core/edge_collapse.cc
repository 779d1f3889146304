#include "core/edge_collapse.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <vector>

#include "core/error.h"

namespace affskel::core {
namespace {

namespace simplification = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

SurfaceMesh to_cgal(const Mesh& mesh) {
  SurfaceMesh out;
  out.reserve(static_cast<SurfaceMesh::size_type>(mesh.points.size()),
              static_cast<SurfaceMesh::size_type>(mesh.triangles.size() * 3 / 2),
              static_cast<SurfaceMesh::size_type>(mesh.triangles.size()));
  for (const Vec3& p : mesh.points) out.add_vertex({p.x, p.y, p.z});
  using Vertex = SurfaceMesh::Vertex_index;
  for (const Triangle& t : mesh.triangles) {
    if (out.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])) == SurfaceMesh::null_face()) {
      throw CoreError(CoreError::Code::kInternal, "edge collapse: the mesh is not manifold");
    }
  }
  return out;
}

Mesh from_cgal(SurfaceMesh& mesh) {
  mesh.collect_garbage();
  Mesh out;
  for (const auto v : mesh.vertices()) {
    const auto& p = mesh.point(v);
    out.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) t[k++] = v;
    out.triangles.push_back(t);
  }
  return out;
}

}  // namespace

Mesh collapse_edges(const Mesh& mesh, std::size_t triangles) {
  SurfaceMesh surface = to_cgal(mesh);
  using Placement = simplification::LindstromTurk_placement<SurfaceMesh>;
  // A closed mesh of n triangles has 3 n / 2 edges; the predicate stops below its count.
  const simplification::Count_stop_predicate<SurfaceMesh> stop(triangles / 2 * 3 + 1);
  simplification::edge_collapse(
      surface, stop,
      CGAL::parameters::get_cost(simplification::LindstromTurk_cost<SurfaceMesh>())
          .get_placement(simplification::Bounded_normal_change_placement<Placement>(Placement())));
  return from_cgal(surface);
}

}  // namespace affskel::core
