#include "core/repair/alpha_wrap.h"

#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/unit.h"
#include "core/shapes/surface_mesh.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

// Leaves the wrapping when the context asks to stop.
struct StopVisitor : CGAL::Alpha_wraps_3::internal::Wrapping_default_visitor {
  ExecutionContext* context;

  explicit StopVisitor(ExecutionContext* asked) : context(asked) {}
  template <class Wrapper, class Gate>
  void before_facet_treatment(const Wrapper&, const Gate&) const {
    throw_if_stopped(context);
  }
};

// Unit normals of vertices, weighted by area.
std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.points.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 area = twice_area(mesh, t);
    for (const std::uint32_t v : t) normals[v] = normals[v] + area;
  }
  for (Vec3& normal : normals) normal = unit(normal);
  return normals;
}

}  // namespace

Mesh alpha_wrap(const Mesh& mesh, const AlphaWrapOptions& options) {
  if (mesh.points.empty()) refuse("there is nothing to wrap");
  std::vector<Point> points;
  for (const Vec3& p : mesh.points) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const Triangle& t : mesh.triangles) {
    // CGAL's tree does not bear triangles without area.
    if (!CGAL::collinear(points[t[0]], points[t[1]], points[t[2]])) triangles.push_back({t[0], t[1], t[2]});
  }
  if (triangles.empty() && !mesh.triangles.empty())
    refuse("no triangle has an area, so there is nothing to wrap");
  SurfaceMesh wrap;
  StopVisitor visitor(options.context);
  const auto given = CGAL::parameters::default_values();
  std::vector<Point> seeds;  // none: from outside
  if (options.from) seeds.emplace_back(options.from->x, options.from->y, options.from->z);
  const auto stop = CGAL::parameters::visitor(std::ref(visitor)).seed_points(std::ref(seeds));
  if (triangles.empty()) {
    CGAL::alpha_wrap_3(points, options.alpha, options.offset, wrap, given, stop);
  } else {
    CGAL::alpha_wrap_3(points, triangles, options.alpha, options.offset, wrap, given, stop);
  }
  Mesh wrapped = mesh_of(wrap);
  if (wrapped.triangles.empty() && options.from) return wrapped;
  if (wrapped.triangles.empty()) refuse("the wrap is empty; take a smaller alpha");
  // CGAL turns what bounds a cavity as if it bounded a solid.
  if (options.from)
    for (Triangle& t : wrapped.triangles) std::swap(t[1], t[2]);
  return wrapped;
}

void take_back_offset(Mesh& wraps, const AlphaWrapOptions& options) {
  constexpr double kLeast = 1.0 / 16;  // of the offset: less is none
  const std::vector<Vec3> normals = vertex_normals(wraps), places = wraps.points;
  std::vector<double> moves(places.size(), options.offset);
  for (bool again = true; again;) {  // every time one at least moves less, five times each at most
    for (std::size_t v = 0; v < places.size(); ++v) wraps.points[v] = places[v] - moves[v] * normals[v];
    std::vector<bool> meets(places.size());
    for (const auto& [i, j] : self_intersections(wraps, {wraps.triangles.size(), 1, options.context}))
      for (const std::uint32_t t : {i, j})
        for (const std::uint32_t v : wraps.triangles[t]) meets[v] = true;
    again = false;
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (!meets[v] || moves[v] == 0) continue;
      moves[v] = moves[v] > kLeast * options.offset ? 0.5 * moves[v] : 0;
      again = true;
    }
  }
}

}  // namespace affskel::core
