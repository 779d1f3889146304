#include "voronoi_axis.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/solid/surface_samples.h"

namespace affskel::experiments {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel>;

constexpr unsigned kRemeshingRounds = 3;
constexpr double kEdge = 0.5;  // of the mean edge: longer ones cut corners off the solid

Surface surface_of(const core::Mesh& mesh) {
  Surface surface;
  for (const core::Vec3& p : mesh.points) surface.add_vertex({p.x, p.y, p.z});
  using Vertex = Surface::Vertex_index;
  for (const core::Triangle& t : mesh.triangles) surface.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2]));
  return surface;
}

}  // namespace

std::vector<core::Vec3> inner_poles(const core::Mesh& mesh, std::size_t samples) {
  const Surface surface = surface_of(mesh);
  const CGAL::Side_of_triangle_mesh<Surface, Kernel> side(surface);
  std::vector<Point> points;
  for (const core::Vec3& p : core::surface_samples(mesh, samples)) points.emplace_back(p.x, p.y, p.z);
  const Delaunay delaunay(points.begin(), points.end());
  std::vector<core::Vec3> poles;
  std::vector<Delaunay::Cell_handle> cells, taken;
  for (const auto vertex : delaunay.finite_vertex_handles()) {
    cells.clear();
    delaunay.finite_incident_cells(vertex, std::back_inserter(cells));
    Delaunay::Cell_handle farthest;
    double most = 0;
    for (const auto cell : cells) {
      const Point centre = delaunay.dual(cell);
      const double away = CGAL::to_double(CGAL::squared_distance(centre, vertex->point()));
      if (away <= most || side(centre) != CGAL::ON_BOUNDED_SIDE) continue;
      most = away;
      farthest = cell;
    }
    if (farthest != Delaunay::Cell_handle()) taken.push_back(farthest);
  }
  std::sort(taken.begin(), taken.end());
  taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
  for (const auto cell : taken) {
    const Point centre = delaunay.dual(cell);
    poles.push_back({centre.x(), centre.y(), centre.z()});
  }
  return poles;
}

core::Mesh remeshed_isotropically(const core::Mesh& mesh) {
  Surface surface = surface_of(mesh);
  double length = 0;
  for (const auto edge : surface.edges())
    length += std::sqrt(CGAL::squared_distance(surface.point(surface.vertex(edge, 0)),
                                               surface.point(surface.vertex(edge, 1))));
  length *= kEdge / static_cast<double>(surface.number_of_edges());
  CGAL::Polygon_mesh_processing::isotropic_remeshing(
      surface.faces(), length, surface, CGAL::parameters::number_of_iterations(kRemeshingRounds));
  surface.collect_garbage();
  core::Mesh result;
  for (const auto vertex : surface.vertices()) {
    const Point& p = surface.point(vertex);
    result.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto face : surface.faces()) {
    core::Triangle triangle{};
    std::size_t corner = 0;
    for (const auto vertex : surface.vertices_around_face(surface.halfedge(face)))
      triangle[corner++] = vertex;
    result.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace affskel::experiments
