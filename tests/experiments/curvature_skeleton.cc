#include "curvature_skeleton.h"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Face_filtered_graph.h>
#include <CGAL/boost/graph/copy_face_graph.h>
#include <CGAL/extract_mean_curvature_flow_skeleton.h>

#include <cstdint>
#include <stdexcept>

#include "core/base/disjoint_sets.h"
#include "core/base/stopwatch.h"

namespace affskel::experiments {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Skeletonization = CGAL::Mean_curvature_flow_skeletonization<Surface>;

Surface surface_of(const core::Mesh& mesh) {
  Surface surface;
  for (const core::Vec3& p : mesh.points) surface.add_vertex({p.x, p.y, p.z});
  using Vertex = Surface::Vertex_index;
  for (const core::Triangle& t : mesh.triangles) {
    if (surface.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])) == Surface::null_face())
      throw std::runtime_error("CGAL takes no surface with edges of more than two triangles");
  }
  return surface;
}

void add_skeleton_of(const Surface& surface, CurveSkeleton& result) {
  Skeletonization::Skeleton skeleton;
  CGAL::extract_mean_curvature_flow_skeleton(surface, skeleton);
  const auto first = static_cast<std::uint32_t>(result.points.size());
  for (const auto vertex : CGAL::make_range(vertices(skeleton))) {
    const Point& p = skeleton[vertex].point;
    result.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto edge : CGAL::make_range(edges(skeleton)))
    result.segments.push_back({first + static_cast<std::uint32_t>(source(edge, skeleton)),
                               first + static_cast<std::uint32_t>(target(edge, skeleton))});
}

}  // namespace

CurveSkeleton curvature_skeleton(const core::Mesh& mesh) {
  const core::Stopwatch clock;
  CurveSkeleton result;
  const Surface whole = surface_of(mesh);
  std::vector<std::size_t> part(whole.number_of_faces());
  const auto part_of = CGAL::make_property_map(part);
  const std::size_t parts = CGAL::Polygon_mesh_processing::connected_components(whole, part_of);
  for (std::size_t n = 0; n < parts; ++n) {
    Surface one;
    CGAL::copy_face_graph(CGAL::Face_filtered_graph<Surface>(whole, n, part_of), one);
    add_skeleton_of(one, result);
  }
  result.seconds = clock.seconds();
  core::DisjointSets sets(result.points.size());
  result.betti.components = result.points.size();
  for (const core::Segment& segment : result.segments) {
    if (sets.unite(segment[0], segment[1]))
      --result.betti.components;
    else
      ++result.betti.holes;
  }
  return result;
}

}  // namespace affskel::experiments
