#include "core/spatial/distance_to_mesh.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace affskel::core {
namespace {

double square(const Vec3& v) {
  return dot(v, v);
}

double squared_distance_to_side(const Vec3& place, const Vec3& a, const Vec3& b) {
  const Vec3 side = b - a, way = place - a;
  const double length = square(side);
  const double t = length > 0 ? std::clamp(dot(way, side) / length, 0.0, 1.0) : 0;
  return square(way - t * side);
}

// The boxes that are not farther away than the nearest triangle so far.
struct Nearer {
  const Vec3& place;
  double& least;  // squared

  bool meets(const Box& box) const {
    const auto out = [](double at, double low, double high) { return std::max({low - at, at - high, 0.0}); };
    return square(Vec3{out(place.x, box.low[0], box.high[0]), out(place.y, box.low[1], box.high[1]),
                       out(place.z, box.low[2], box.high[2])}) <= least;
  }
};

std::vector<Vec3> corners_of(const Mesh& mesh) {
  std::vector<Vec3> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) corners.push_back(mesh.points[corner]);
  return corners;
}

}  // namespace

double squared_distance(const Vec3& place, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = cross(b - a, c - a);
  const double size = square(normal);
  const bool above = size > 0 && dot(cross(b - a, normal), place - a) <= 0 &&
                     dot(cross(c - b, normal), place - b) <= 0 && dot(cross(a - c, normal), place - c) <= 0;
  if (above) {
    const double height = dot(normal, place - a);
    return height * height / size;
  }
  return std::min({squared_distance_to_side(place, a, b), squared_distance_to_side(place, b, c),
                   squared_distance_to_side(place, c, a)});
}

DistanceToMesh::DistanceToMesh(const Mesh& mesh)
    : mesh_(mesh), tree_(boxes_of(mesh)), corners_(corners_of(mesh)) {}

double DistanceToMesh::nearest(const Vec3& place) const {
  const double corner = corners_.nearest(place);
  double least = corner * corner * (1 + 1e-12);  // for what rounding does to the boxes' distances
  tree_.visit(Nearer{place, least}, [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh_.triangles[t];
    least = std::min(least, squared_distance(place, mesh_.points[a], mesh_.points[b], mesh_.points[c]));
  });
  return std::sqrt(least);
}

}  // namespace affskel::core
