#include "core/shapes/edge_collapse.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "core/shapes/crossing_guard.h"
#include "core/shapes/surface_mesh.h"

namespace affskel::core {
namespace {

namespace simplification = CGAL::Surface_mesh_simplification;

class FaceCountStop {
 public:
  explicit FaceCountStop(std::size_t faces) : faces_(faces) {}

  template <typename Cost, typename Profile>
  bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
    return profile.surface_mesh().number_of_faces() <= faces_;
  }

 private:
  std::size_t faces_;
};

/// Lindstrom and Turk's placement, held in the half space and on the plane of the border; no placement
/// for collapses that must not be.
class Placement {
 public:
  Placement(std::size_t faces, StopCheck& stop) : faces_(faces), stop_(&stop) {}

  template <typename Profile>
  boost::optional<Point> operator()(const Profile& profile) const {
    stop_->did(kOperations);
    const SurfaceMesh& mesh = profile.surface_mesh();
    const bool border_edge = mesh.is_border(profile.v0_v1()) || mesh.is_border(profile.v1_v0());
    if (mesh.number_of_faces() < faces_ + (border_edge ? 1 : 2)) return boost::none;  // fewer than asked for
    auto place = bounded_(profile);
    if (!place) return place;
    if (!mesh.is_border(profile.v0()) && !mesh.is_border(profile.v1())) {
      return place->x() > 0 ? place : boost::none;
    }
    if (makes_chord(profile)) return boost::none;
    return Point(0, place->y(), place->z());
  }

 private:
  /// Whether the merged vertex, on the border, would be joined to another vertex of the border by an edge
  /// that is not on the border: with the mirror image that edge would have four triangles.
  template <typename Profile>
  static bool makes_chord(const Profile& profile) {
    const SurfaceMesh& mesh = profile.surface_mesh();
    for (const auto w : profile.link()) {
      if (mesh.is_border(w) && !border_edge(mesh, profile.v0(), w) && !border_edge(mesh, profile.v1(), w)) {
        return true;
      }
    }
    return false;
  }

  static bool border_edge(const SurfaceMesh& mesh, SurfaceMesh::Vertex_index v, SurfaceMesh::Vertex_index w) {
    const auto h = mesh.halfedge(v, w);
    return h != SurfaceMesh::null_halfedge() && mesh.is_border(mesh.edge(h));
  }

  using Optimal = simplification::LindstromTurk_placement<SurfaceMesh>;

  static constexpr std::uint64_t kOperations = 1000;  // of a placement, some nanoseconds each

  std::size_t faces_;
  StopCheck* stop_;
  simplification::Bounded_normal_change_placement<Optimal> bounded_{Optimal()};
};

/// Refuses what a guard, if any, does not allow.  CGAL asks it just before a collapse, when nothing else changes any more.
struct UncrossedFilter {
  std::optional<CrossingGuard>& guard;

  template <typename Profile>
  boost::optional<Point> operator()(const Profile& profile, const boost::optional<Point>& place) const {
    if (!guard || !place) return place;
    std::vector<Triangle> star;
    for (const auto& t : profile.triangles()) {  // its second corner is an end of the edge
      if (t.v0 == profile.v0() || t.v0 == profile.v1() || t.v2 == profile.v0() || t.v2 == profile.v1())
        continue;
      star.push_back({t.v0, guard->merged(), t.v2});
    }
    const bool crosses =
        guard->would_cross(profile.v0(), profile.v1(), {place->x(), place->y(), place->z()}, star);
    return crosses ? boost::none : place;
  }
};

struct GuardVisitor : simplification::Edge_collapse_visitor_base<SurfaceMesh> {
  explicit GuardVisitor(std::optional<CrossingGuard>& of) : guard(of) {}

  void OnCollapsed(const Profile&, const vertex_descriptor& v) {
    if (guard) guard->collapsed(v);
  }

  std::optional<CrossingGuard>& guard;
};

}  // namespace

Mesh collapse_edges(const Mesh& mesh, std::size_t triangles, ExecutionContext* context,
                    SelfCrossings crossings) {
  StopCheck stop(context);
  SurfaceMesh surface = surface_mesh_of(mesh);
  std::optional<CrossingGuard> guard;
  if (crossings == SelfCrossings::kNoNewOnes) guard.emplace(surface, triangles);
  simplification::edge_collapse(surface, FaceCountStop(triangles),
                                CGAL::parameters::get_cost(simplification::LindstromTurk_cost<SurfaceMesh>())
                                    .get_placement(Placement(triangles, stop))
                                    .filter(UncrossedFilter{guard})
                                    .visitor(GuardVisitor(guard)));
  surface.collect_garbage();
  return mesh_of(surface);
}

}  // namespace affskel::core
