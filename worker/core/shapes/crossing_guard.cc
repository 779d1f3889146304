#include "core/shapes/crossing_guard.h"

#include <cmath>

#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

Vec3 place_of(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

CrossingGuard::CrossingGuard(const SurfaceMesh& surface, std::size_t triangles) : surface_(surface) {
  for (const auto v : surface.vertices()) points_.push_back(place_of(surface.point(v)));
  points_.emplace_back();
  double area = 0;
  for (const auto face : surface.faces()) {
    const Triangle t = corners(face);
    area += 0.5 * norm(cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]));
  }
  edge_ = 2 * std::sqrt(area / static_cast<double>(triangles));
  for (const auto face : surface.faces()) enter(face);
}

bool CrossingGuard::would_cross(std::uint32_t v, std::uint32_t w, const Vec3& place,
                                std::span<const Triangle> star) {
  points_.back() = place;
  for (std::size_t i = 0; i < star.size(); ++i) {
    const Triangle& t = star[i];
    if (is_degenerate(points_, t)) return true;
    for (std::size_t j = 0; j < i; ++j)
      if (meet_beyond_common(points_, t, star[j])) return true;
    const Box around = box(t);
    bool crosses = false;
    for_each_cell(around, [&](std::uint64_t cell) {
      const auto found = faces_.find(cell);
      if (crosses || found == faces_.end()) return;
      for (const auto face : found->second) {
        if (surface_.is_removed(face)) continue;
        const Triangle other = corners(face);
        if (uses(other, v) || uses(other, w) || !box(other).meets(around)) continue;
        if ((crosses = meet_beyond_common(points_, t, other))) return;
      }
    });
    if (crosses) return true;
  }
  return false;
}

void CrossingGuard::collapsed(SurfaceMesh::Vertex_index v) {
  points_[v] = place_of(surface_.point(v));
  for (const auto face : surface_.faces_around_target(surface_.halfedge(v))) enter(face);
}

template <class Body>
void CrossingGuard::for_each_cell(const Box& box, const Body& body) const {
  const auto cell = [this](double at) { return static_cast<std::int64_t>(std::floor(at / edge_)); };
  for (std::int64_t i = cell(box.low.x); i <= cell(box.high.x); ++i)
    for (std::int64_t j = cell(box.low.y); j <= cell(box.high.y); ++j)
      for (std::int64_t k = cell(box.low.z); k <= cell(box.high.z); ++k) {
        const auto bits = [](std::int64_t n) { return static_cast<std::uint64_t>(n) & 0x1FFFFF; };
        body(bits(i) << 42 | bits(j) << 21 | bits(k));
      }
}

Triangle CrossingGuard::corners(SurfaceMesh::Face_index face) const {
  const auto h = surface_.halfedge(face), next = surface_.next(h);
  return {surface_.target(h), surface_.target(next), surface_.target(surface_.next(next))};
}

Box CrossingGuard::box(const Triangle& t) const {
  Box box;
  for (const std::uint32_t v : t) box.include(points_[v]);
  return box;
}

void CrossingGuard::enter(SurfaceMesh::Face_index face) {
  for_each_cell(box(corners(face)), [&](std::uint64_t cell) { faces_[cell].push_back(face); });
}

}  // namespace affskel::core
