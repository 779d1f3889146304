#include "core/surface/alpha_shape.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "core/base/error.h"
#include "core/mesh/box.h"
#include "core/mesh/coincident_points.h"
#include "core/mesh/unused_points.h"

namespace affskel::core {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;  // index of the point
using CellBase = CGAL::Triangulation_cell_base_with_info_3<bool, Kernel,  // inside the alpha shape
                                                           CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Point = Kernel::Point_3;

/// The squared radius that the options ask for.
double checked_alpha(const AlphaShapeOptions& options) {
  if (!(std::isfinite(options.alpha) && options.alpha >= 0)) {
    refuse("alpha surface: alpha must be a finite number >= 0, not " + base::to_text(options.alpha));
  }
  if (!(std::isfinite(options.spacing) && options.spacing >= 0)) {
    refuse("alpha surface: the spacing must be a finite number >= 0, not " + base::to_text(options.spacing));
  }
  if (options.alpha > 0) return options.alpha;
  if (options.spacing == 0) refuse("alpha surface: either alpha or the spacing must be given");
  return 3 * options.spacing * options.spacing;
}

void check_finite(std::span<const Vec3> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i]))
      refuse("alpha surface: point " + std::to_string(i) + " has a coordinate that is not finite");
  }
}

/// The points in units of the spacing, as whole numbers, when they lie on an axis-parallel lattice.
std::optional<std::vector<Vec3>> lattice_coordinates(std::span<const Vec3> points, double spacing) {
  if (!(spacing > 0)) return std::nullopt;
  constexpr double kTolerance = 1e-6;
  constexpr double kMaxSteps = 1 << 24;
  const Vec3 low = box_of(points).low;
  bool whole = true;
  const auto snap = [&](double difference) {
    const double steps = difference / spacing, nearest = std::round(steps);
    whole = whole && std::abs(steps - nearest) <= kTolerance && nearest <= kMaxSteps;
    return nearest;
  };
  std::vector<Vec3> snapped;
  snapped.reserve(points.size());
  for (const Vec3& p : points) {
    snapped.push_back({snap(p.x - low.x), snap(p.y - low.y), snap(p.z - low.z)});
    if (!whole) return std::nullopt;
  }
  return snapped;
}

/// The distinct points, each with the index of its first copy.
std::vector<std::pair<Point, std::uint32_t>> distinct(std::span<const Vec3> points) {
  const std::vector<std::uint32_t> first = first_coincident_point(points);
  std::vector<std::pair<Point, std::uint32_t>> sites;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (first[i] == i) sites.emplace_back(Point(points[i].x, points[i].y, points[i].z), i);
  return sites;
}

double squared_circumradius(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a;
  const Vec3 n = cross(u, v);
  return dot(u, u) * dot(v, v) * dot(u - v, u - v) / (4 * dot(n, n));
}

double squared_circumradius(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 vw = cross(v, w);
  const Vec3 sum = dot(u, u) * vw + dot(v, v) * cross(w, u) + dot(w, w) * cross(u, v);
  const double volume = 2 * dot(u, vw);
  return dot(sum, sum) / (volume * volume);
}

class AlphaShape {
 public:
  AlphaShape(std::span<const Vec3> points, double alpha, ExecutionContext* context)
      : limit_(alpha * (1 + 1e-9)), stop_(context) {
    insert(distinct(points));
  }

  /// Triangles by index of point, in canonical order.
  std::vector<Triangle> triangles() {
    if (delaunay_.dimension() == 3) {
      for (const auto cell : delaunay_.finite_cell_handles()) {
        stop_.did(kCell);
        cell->info() = is_inside(cell);
      }
      for (const auto cell : infinite_cells()) cell->info() = false;
    }
    std::vector<Triangle> found;
    if (delaunay_.dimension() >= 2) {
      for (const auto& facet : delaunay_.finite_facets()) {
        stop_.did(kCell);
        add(facet, found);
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  using Cell = Delaunay::Cell_handle;
  using Site = std::pair<Point, std::uint32_t>;
  static constexpr std::uint64_t kCell = 20, kInsertion = 500;  // some nanoseconds each

  // One by one, near ones after each other, as CGAL inserts a range, in which it cannot be stopped.
  void insert(std::vector<Site> sites) {
    using Order = CGAL::Spatial_sort_traits_adapter_3<Kernel, CGAL::First_of_pair_property_map<Site>>;
    CGAL::spatial_sort(sites.begin(), sites.end(), Order());
    Delaunay::Vertex_handle last;
    for (const auto& [place, index] : sites) {
      stop_.did(kInsertion);
      last = delaunay_.insert(place, last);
      last->info() = index;
    }
  }

  std::vector<Cell> infinite_cells() const {
    std::vector<Cell> cells;
    delaunay_.incident_cells(delaunay_.infinite_vertex(), std::back_inserter(cells));
    return cells;
  }

  static Vec3 place(Delaunay::Vertex_handle v) { return {v->point().x(), v->point().y(), v->point().z()}; }

  bool is_inside(Cell c) const {
    return squared_circumradius(place(c->vertex(0)), place(c->vertex(1)), place(c->vertex(2)),
                                place(c->vertex(3))) <= limit_;
  }

  void add(const Delaunay::Facet& facet, std::vector<Triangle>& found) const {
    if (delaunay_.dimension() == 2) {
      if (is_small(facet)) found.push_back(standing_alone(facet));
      return;
    }
    const Delaunay::Facet mirror = delaunay_.mirror_facet(facet);
    const bool here = facet.first->info(), there = mirror.first->info();
    if (here != there) {
      found.push_back(facing_out(here ? facet : mirror));
    } else if (!here && is_small(facet) && delaunay_.is_Gabriel(facet)) {
      found.push_back(standing_alone(facet));
    }
  }

  static std::array<Delaunay::Vertex_handle, 3> corners(const Delaunay::Facet& facet) {
    std::array<Delaunay::Vertex_handle, 3> out;
    std::size_t k = 0;
    for (int i = 0; i < 4; ++i) {
      if (i != facet.second) out[k++] = facet.first->vertex(i);
    }
    return out;
  }

  bool is_small(const Delaunay::Facet& facet) const {
    const auto v = corners(facet);
    return squared_circumradius(place(v[0]), place(v[1]), place(v[2])) <= limit_;
  }

  /// The triangle with its smallest index first; the other two in the given order or swapped.
  static Triangle canonical(const std::array<Delaunay::Vertex_handle, 3>& v, bool swap) {
    Triangle t{v[0]->info(), v[swap ? 2 : 1]->info(), v[swap ? 1 : 2]->info()};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  }

  /// The facet of a cell inside the shape whose neighbour is outside.
  static Triangle facing_out(const Delaunay::Facet& facet) {
    const auto v = corners(facet);
    const Point& inner = facet.first->vertex(facet.second)->point();
    return canonical(v,
                     CGAL::orientation(v[0]->point(), v[1]->point(), v[2]->point(), inner) == CGAL::POSITIVE);
  }

  static Triangle standing_alone(const Delaunay::Facet& facet) {
    const auto v = corners(facet);
    const Vec3 n = cross(place(v[1]) - place(v[0]), place(v[2]) - place(v[0]));
    int largest = 0;
    for (int k = 1; k < 3; ++k) {
      if (std::abs(n[k]) > std::abs(n[largest])) largest = k;
    }
    return canonical(v, n[largest] < 0);
  }

  double limit_;
  StopCheck stop_;
  Delaunay delaunay_;
};

Mesh with_used_points(std::span<const Vec3> points, std::vector<Triangle> triangles) {
  Mesh mesh{{points.begin(), points.end()}, std::move(triangles)};
  drop_unused_points(mesh);
  return mesh;
}

}  // namespace

Mesh alpha_shape(std::span<const Vec3> points, const AlphaShapeOptions& options) {
  const double alpha = checked_alpha(options);
  check_finite(points);
  if (points.size() < 3) return {};
  if (const auto snapped = lattice_coordinates(points, options.spacing)) {
    const double steps = std::sqrt(alpha) / options.spacing;
    return with_used_points(points, AlphaShape(*snapped, steps * steps, options.context).triangles());
  }
  return with_used_points(points, AlphaShape(points, alpha, options.context).triangles());
}

}  // namespace affskel::core
