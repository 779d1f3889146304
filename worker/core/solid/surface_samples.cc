#include "core/solid/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace affskel::core {
namespace {

double area_of(const Mesh& mesh, const Triangle& t) {
  return 0.5 * norm(twice_area(mesh, t));
}

double fraction(double x) {
  return x - std::floor(x);
}

// Point number i of the R2 sequence, in the triangle.
Vec3 point_in(const Mesh& mesh, const Triangle& t, double i) {
  // 1/g and 1/g^2 with g^3 = g + 1.
  double u = fraction(0.5 + i * 0.75487766624669276), v = fraction(0.5 + i * 0.56984029099805327);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const Vec3& a = mesh.points[t[0]];
  return a + (u * (mesh.points[t[1]] - a) + v * (mesh.points[t[2]] - a));
}

}  // namespace

double curve_length(std::span<const Vec3> points, std::span<const Segment> segments) {
  double length = 0;
  for (const auto& [a, b] : segments) length += norm(points[b] - points[a]);
  return length;
}

std::vector<Vec3> curve_samples(std::span<const Vec3> points, std::span<const Segment> segments,
                                std::size_t count) {
  const double total = curve_length(points, segments);
  if (!(total > 0) || !std::isfinite(total)) {
    refuse("the curves have no length to take points from");
  }
  const double per_length = static_cast<double>(count) / total;
  std::vector<Vec3> samples;
  samples.reserve(count);
  double swept = 0;
  for (const auto& [a, b] : segments) {
    const Vec3 along = points[b] - points[a];
    const double length = norm(along), begin = swept;
    swept += length;
    // Sample i lies where i and a half of the shares are swept.
    while (samples.size() < count) {
      const double place = (static_cast<double>(samples.size()) + 0.5) / per_length;
      if (place > swept) break;
      samples.push_back(points[a] + std::min(1.0, (place - begin) / length) * along);
    }
  }
  return samples;
}

double surface_area(const Mesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += area_of(mesh, t);
  return area;
}

std::vector<Vec3> surface_samples(const Mesh& mesh, std::size_t count) {
  const double total = surface_area(mesh);
  if (!(total > 0) || !std::isfinite(total)) {
    refuse("the surface has no area to take points from");
  }
  const double per_area = static_cast<double>(count) / total;
  std::vector<Vec3> points;
  points.reserve(count);
  double swept = 0;
  for (const Triangle& t : mesh.triangles) {
    swept += area_of(mesh, t);
    // Point i stands for the areas from i to i + 1 and lies where half of that is swept.
    while (points.size() < count && static_cast<double>(points.size()) + 0.5 <= swept * per_area) {
      points.push_back(point_in(mesh, t, static_cast<double>(points.size())));
    }
  }
  return points;
}

}  // namespace affskel::core
