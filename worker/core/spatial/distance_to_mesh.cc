#include "core/spatial/distance_to_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/mesh/unused_points.h"

namespace affskel::core {
namespace {

Vec3 nearest_on_side(const Vec3& place, const Vec3& a, const Vec3& b) {
  const Vec3 side = b - a;
  const double length = dot(side, side);
  const double t = length > 0 ? std::clamp(dot(place - a, side) / length, 0.0, 1.0) : 0;
  return a + t * side;
}

// The boxes that are not farther away than the nearest triangle so far.
struct Nearer {
  const Vec3& place;
  double& least;  // squared

  bool meets(const Box& box) const { return box.squared_distance(place) <= least; }
};

// The points that triangles use.
std::vector<Vec3> corners_of(Mesh mesh) {
  drop_unused_points(mesh);
  return std::move(mesh.points);
}

}  // namespace

Vec3 nearest_place(const Vec3& place, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = cross(b - a, c - a);
  const double size = dot(normal, normal);
  const bool above = size > 0 && dot(cross(b - a, normal), place - a) <= 0 &&
                     dot(cross(c - b, normal), place - b) <= 0 && dot(cross(a - c, normal), place - c) <= 0;
  if (above) return place - (dot(normal, place - a) / size) * normal;
  const std::array<Vec3, 3> sides = {nearest_on_side(place, a, b), nearest_on_side(place, b, c),
                                     nearest_on_side(place, c, a)};
  return *std::min_element(sides.begin(), sides.end(), [&](const Vec3& p, const Vec3& q) {
    return squared_distance(p, place) < squared_distance(q, place);
  });
}

DistanceToMesh::DistanceToMesh(const Mesh& mesh, unsigned threads)
    : mesh_(mesh), tree_(boxes_of(mesh), threads), corners_(corners_of(mesh)), corner_index_(corners_) {}

double DistanceToMesh::nearest(const Vec3& place) const {
  return norm(nearest_place(place) - place);
}

Vec3 DistanceToMesh::nearest_place(const Vec3& place) const {
  const PointIndex::Found corner = corner_index_.find(place);
  double least =
      corner.distance * corner.distance * (1 + 1e-12);  // for what rounding does to the boxes' distances
  const auto at = [&](std::uint32_t triangle, std::size_t k) {
    return mesh_.points[mesh_.triangles[triangle][k]];
  };
  Vec3 found = corners_[corner.number];
  tree_.visit(Nearer{place, least}, [&](std::uint32_t t) {
    const Vec3 here = core::nearest_place(place, at(t, 0), at(t, 1), at(t, 2));
    const double distance = squared_distance(here, place);
    if (distance >= least) return;
    least = distance;
    found = here;
  });
  return found;
}

}  // namespace affskel::core
