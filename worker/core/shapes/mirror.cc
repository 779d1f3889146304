#include "core/shapes/mirror.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <vector>
#include "core/mesh/unused_points.h"

namespace affskel::core {
namespace {

/// The vertices where edges cross the plane, one per edge.
class Crossings {
 public:
  explicit Crossings(std::vector<Vec3>& points) : points_(points) {}

  std::uint32_t at(std::uint32_t v, std::uint32_t w) {
    const auto [place, is_new] =
        vertex_.try_emplace(ascending(v, w), static_cast<std::uint32_t>(points_.size()));
    if (is_new) {
      const Vec3 p = points_[place->first[0]], q = points_[place->first[1]];
      const double t = p.x / (p.x - q.x);
      points_.push_back({0, p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)});
    }
    return place->second;
  }

 private:
  std::vector<Vec3>& points_;
  std::map<Segment, std::uint32_t> vertex_;
};

/// Appends what lies at x >= 0 of a triangle that reaches x > 0.
void add_clipped(const Triangle& t, const std::vector<Vec3>& points, Crossings& crossings,
                 std::vector<Triangle>& out) {
  std::array<std::uint32_t, 4> corner{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = t[k], w = t[(k + 1) % 3];
    const double at_v = points[v].x, at_w = points[w].x;
    if (at_v >= 0) corner[count++] = v;
    if ((at_v > 0 && at_w < 0) || (at_v < 0 && at_w > 0)) corner[count++] = crossings.at(v, w);
  }
  out.push_back({corner[0], corner[1], corner[2]});
  if (count == 4) out.push_back({corner[0], corner[2], corner[3]});
}

}  // namespace

Mesh positive_x_half(Mesh mesh, double snap) {
  for (Vec3& p : mesh.points) {
    if (std::abs(p.x) < snap) p.x = 0;
  }
  std::vector<Triangle> kept;
  Crossings crossings(mesh.points);
  for (const Triangle& t : mesh.triangles) {
    const bool reaches = mesh.points[t[0]].x > 0 || mesh.points[t[1]].x > 0 || mesh.points[t[2]].x > 0;
    if (reaches) add_clipped(t, mesh.points, crossings, kept);
  }
  mesh.triangles = std::move(kept);
  // Not drop_unused_points(): which of two equal edges is collapsed first goes by these numbers, and with it the
  // demo body's bytes.
  return numbered_by_first_use(mesh);
}

Mesh with_mirror_image(const Mesh& half) {
  Mesh mesh = half;
  std::vector<std::uint32_t> image(half.points.size());
  for (std::uint32_t v = 0; v < image.size(); ++v) {
    const Vec3& p = half.points[v];
    image[v] = p.x == 0 ? v : static_cast<std::uint32_t>(mesh.points.size());
    if (p.x != 0) mesh.points.push_back({-p.x, p.y, p.z});
  }
  for (const Triangle& t : half.triangles) {
    mesh.triangles.push_back({image[t[0]], image[t[2]], image[t[1]]});
  }
  return mesh;
}

}  // namespace affskel::core
