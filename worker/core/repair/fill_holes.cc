#include "core/repair/fill_holes.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/fair.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <iterator>

#include "core/repair/orient_soup.h"
#include "core/shapes/surface_mesh.h"

namespace affskel::core {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;

using Halfedge = SurfaceMesh::Halfedge_index;
using Face = SurfaceMesh::Face_index;

constexpr double kPlane = 1e-6;  // of the loop's length: farther from its plane it is not plane

// Where Delaunay's triangulation has no answer time grows with the cube of a loop's edges.
constexpr std::uint64_t kMaxCubic = 500;

struct Loop {
  Halfedge edge;
  Hole hole;
  bool plane = false;
};

std::vector<Vec3> points_of(const SurfaceMesh& surface, Halfedge edge) {
  std::vector<Vec3> points;
  for (const Halfedge h : CGAL::halfedges_around_face(edge, surface)) {
    const Point& p = surface.point(surface.target(h));
    points.push_back({p.x(), p.y(), p.z()});
  }
  return points;
}

// Whether points lie in the plane through their middle along their area's normal.
bool lie_in_a_plane(const std::vector<Vec3>& points, const Vec3& centre, double length) {
  Vec3 normal{};
  for (std::size_t i = 0; i < points.size(); ++i)
    normal = normal + cross(points[i] - centre, points[(i + 1) % points.size()] - centre);
  const double area = norm(normal);
  if (!(area > 0)) return false;
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
    return std::fabs(dot(p - centre, normal)) <= kPlane * length * area;
  });
}

Loop loop_at(const SurfaceMesh& surface, Halfedge edge) {
  Loop loop{edge, {}, false};
  loop.hole.point = surface.target(edge);
  const std::vector<Vec3> points = points_of(surface, edge);
  loop.hole.edges = points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    loop.hole.length += norm(points[(i + 1) % points.size()] - points[i]);
    loop.hole.centre = loop.hole.centre + (1.0 / double(points.size())) * points[i];
  }
  loop.plane = lie_in_a_plane(points, loop.hole.centre, loop.hole.length);
  return loop;
}

double area_of(const SurfaceMesh& surface, const std::vector<Face>& faces) {
  double area = 0;
  for (const Face face : faces) {
    const std::vector<Vec3> p = points_of(surface, surface.halfedge(face));
    area += 0.5 * norm(cross(p[1] - p[0], p[2] - p[0]));
  }
  return area;
}

// Of the cone from `top`; of cones on surfaces with the same rim the difference is the volume between them.
double cone_volume(const SurfaceMesh& surface, const std::vector<Face>& faces, const Vec3& top) {
  double volume = 0;
  for (const Face face : faces) {
    const std::vector<Vec3> p = points_of(surface, surface.halfedge(face));
    volume += six_volumes(top, p[0], p[1], p[2]) / 6;
  }
  return volume;
}

// Leaves CGAL's search for a triangulation, which takes seconds for thousands of edges, when the context asks to stop.
struct StopVisitor : PMP::Hole_filling::Default_visitor {
  ExecutionContext* context;

  explicit StopVisitor(ExecutionContext* asked) : context(asked) {}
  void quadratic_step() const { throw_if_stopped(context); }
  void cubic_step() const { throw_if_stopped(context); }
  void start_refine_phase() const { throw_if_stopped(context); }
};

// Bends the faces as their rim does; returns the volume between them and a soap film.
double fair(SurfaceMesh& surface, const std::vector<SurfaceMesh::Vertex_index>& vertices,
            const std::vector<Face>& faces, const Vec3& centre, ExecutionContext* context) {
  std::vector<Point> refined;
  for (const auto vertex : vertices) refined.push_back(surface.point(vertex));
  PMP::fair(surface, vertices, CGAL::parameters::fairing_continuity(0));
  const double film = cone_volume(surface, faces, centre);
  for (std::size_t i = 0; i < vertices.size(); ++i) surface.point(vertices[i]) = refined[i];
  throw_if_stopped(context);
  PMP::fair(surface, vertices, CGAL::parameters::fairing_continuity(2));
  return std::fabs(cone_volume(surface, faces, centre) - film);
}

void fill(SurfaceMesh& surface, Loop& loop, ExecutionContext* context) {
  std::vector<Face> faces;
  const auto how =
      CGAL::parameters::do_not_use_cubic_algorithm(loop.hole.edges > kMaxCubic).visitor(StopVisitor(context));
  if (loop.plane || loop.hole.edges == 3) {
    PMP::triangulate_hole(surface, loop.edge, std::back_inserter(faces), how);
  } else {
    std::vector<SurfaceMesh::Vertex_index> vertices;
    PMP::triangulate_and_refine_hole(surface, loop.edge, std::back_inserter(faces),
                                     std::back_inserter(vertices), how);
    loop.hole.bulge = fair(surface, vertices, faces, loop.hole.centre, context);
  }
  loop.hole.filled = !faces.empty();
  loop.hole.area = area_of(surface, faces);
}

// Longest first.
std::vector<Loop> loops_of(const SurfaceMesh& surface) {
  std::vector<Halfedge> edges;
  PMP::extract_boundary_cycles(surface, std::back_inserter(edges));
  std::vector<Loop> loops;
  for (const Halfedge edge : edges) loops.push_back(loop_at(surface, edge));
  std::stable_sort(loops.begin(), loops.end(),
                   [](const Loop& a, const Loop& b) { return a.hole.length > b.hole.length; });
  return loops;
}

}  // namespace

std::vector<Hole> find_holes(const Mesh& mesh) {
  const SurfaceMesh surface = surface_mesh_of(orient_soup(mesh).mesh);
  std::vector<Hole> holes;
  for (const Loop& loop : loops_of(surface)) holes.push_back(loop.hole);
  return holes;
}

FilledHoles fill_holes(const Mesh& mesh, const FillHolesOptions& options) {
  SurfaceMesh surface = surface_mesh_of(mesh);
  FilledHoles filled;
  for (Loop& loop : loops_of(surface)) {
    throw_if_stopped(options.context);
    if (loop.hole.length <= options.longest && loop.hole.edges <= kMaxHoleEdges)
      fill(surface, loop, options.context);
    filled.holes.push_back(loop.hole);
  }
  filled.mesh = mesh_of(surface);
  return filled;
}

}  // namespace affskel::core
