#include "core/repair/orient_soup.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/mesh/touching_edges.h"
#include "core/mesh/unused_points.h"
#include "core/repair/open_edges.h"
#include "core/shapes/surface_mesh.h"

namespace affskel::core {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;

using Polygon = std::array<std::size_t, 3>;

// A soup as CGAL takes it.
struct Soup {
  std::vector<Point> points;
  std::vector<Polygon> triangles;
};

Soup soup_of(const Mesh& mesh) {
  Soup soup;
  for (const Vec3& p : mesh.points) soup.points.emplace_back(p.x, p.y, p.z);
  for (const Triangle& t : mesh.triangles) soup.triangles.push_back({t[0], t[1], t[2]});
  return soup;
}

Mesh core_mesh(const Soup& soup) {
  Mesh mesh;
  for (const Point& p : soup.points) mesh.points.push_back({p.x(), p.y(), p.z()});
  for (const Polygon& t : soup.triangles)
    mesh.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                              static_cast<std::uint32_t>(t[2])});
  return mesh;
}

// The lesser of those turned and those left: a part may have been turned as a whole.
std::uint64_t turned_since(const std::vector<Polygon>& before, const Soup& soup) {
  std::uint64_t turned = 0;
  for (std::size_t t = 0; t < before.size(); ++t) {
    // Points may have been doubled, but lie where they lay.
    const Polygon& now = soup.triangles[t];
    std::size_t first = 0;
    while (first < 2 && soup.points[now[first]] != soup.points[before[t][0]]) ++first;
    turned += soup.points[now[(first + 1) % 3]] != soup.points[before[t][1]] ? 1 : 0;
  }
  return std::min<std::uint64_t>(turned, before.size() - turned);
}

}  // namespace

OrientedSoup orient_soup(const Mesh& mesh, ExecutionContext* context) {
  OrientedSoup oriented;
  Soup soup = soup_of(mesh);
  oriented.unused_points = PMP::remove_isolated_points_in_polygon_soup(soup.points, soup.triangles);
  oriented.welded_points = PMP::merge_duplicate_points_in_polygon_soup(soup.points, soup.triangles);
  oriented.degenerate = std::erase_if(soup.triangles, [](const Polygon& t) {  // of equal points one is left
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  });
  oriented.repeated = PMP::merge_duplicate_polygons_in_polygon_soup(
      soup.points, soup.triangles,
      CGAL::parameters::erase_all_duplicates(false).require_same_orientation(false));
  PMP::remove_isolated_points_in_polygon_soup(soup.points, soup.triangles);
  if (soup.triangles.empty()) refuse("no triangle with three different corners");
  Mesh split = core_mesh(soup);
  oriented.joined_points = join_near_points(split.points, split.triangles, context);
  drop_unused_points(split);
  const std::size_t points = split.points.size();
  oriented.junctions = split_t_junctions(split.points, split.triangles);
  separate_touching_edges(split);
  soup = soup_of(split);
  const std::vector<Polygon> before = soup.triangles;
  PMP::orient_polygon_soup(soup.points, soup.triangles);
  oriented.turned = turned_since(before, soup);
  oriented.separated_points = soup.points.size() - points;
  SurfaceMesh surface = surface_mesh_of(core_mesh(soup));
  oriented.stitched_edges = PMP::stitch_borders(surface);
  oriented.mesh = mesh_of(surface);
  return oriented;
}

}  // namespace affskel::core
