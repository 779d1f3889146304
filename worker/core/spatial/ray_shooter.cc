#include "core/spatial/ray_shooter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 lower(const Vec3& a, const Vec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec3 upper(const Vec3& a, const Vec3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

// Ray o + s r against the slab of one axis; keeps [near, far].
void clip_slab(double o, double r, double low, double high, double slack, double& near, double& far) {
  if (r == 0) {
    if (o < low - slack || o > high + slack) far = -kInfinity;
    return;
  }
  const double a = (low - slack - o) / r, b = (high + slack - o) / r;
  near = std::max(near, std::min(a, b));
  far = std::min(far, std::max(a, b));
}

// The parameter s at which o + s r meets triangle abc, or infinity.  Moeller & Trumbore (1997), borders
// included.
double hit(const Vec3& o, const Vec3& r, const Vec3& a, const Vec3& b, const Vec3& c, double slack) {
  const Vec3 e = b - a, f = c - a;
  const Vec3 p = cross(r, f);
  const double det = dot(e, p);
  if (det == 0) return kInfinity;
  const Vec3 q = o - a;
  const double u = dot(q, p) / det;
  const Vec3 w = cross(q, e);
  const double v = dot(r, w) / det;
  if (!(u >= -slack && v >= -slack && u + v <= 1 + slack)) return kInfinity;
  return dot(f, w) / det;
}

}  // namespace

RayShooter::RayShooter(const Mesh& mesh, unsigned threads) : mesh_(mesh), triangles_(mesh.triangles.size()) {
  std::iota(triangles_.begin(), triangles_.end(), 0U);
  std::vector<Vec3> centroids;
  centroids.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    centroids.push_back(mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]);
  }
  const auto count = static_cast<std::uint32_t>(triangles_.size());
  nodes_.resize(halving_nodes(count, kLeafSize));
  split(0, 0, count, centroids, threads);
}

RayShooter::Box RayShooter::bounds(std::uint32_t begin, std::uint32_t end) const {
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (std::uint32_t i = begin; i < end; ++i) {
    for (std::uint32_t v : mesh_.triangles[triangles_[i]]) {
      box.low = lower(box.low, mesh_.points[v]);
      box.high = upper(box.high, mesh_.points[v]);
    }
  }
  return box;
}

void RayShooter::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
                       const std::vector<Vec3>& centroids, unsigned threads) {
  const std::uint32_t count = end - begin;
  if (count <= kLeafSize) {
    nodes_[node] = {bounds(begin, end), begin, count};
    return;
  }
  Vec3 low{kInfinity, kInfinity, kInfinity}, high = -low;
  for (std::uint32_t i = begin; i < end; ++i) {
    low = lower(low, centroids[triangles_[i]]);
    high = upper(high, centroids[triangles_[i]]);
  }
  const Vec3 side = high - low;
  const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
  const std::uint32_t middle = begin + count / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](std::uint32_t s, std::uint32_t t) {
                     const double a = centroids[s][axis], b = centroids[t][axis];
                     return a != b ? a < b : s < t;
                   });
  const std::uint32_t second = node + 1 + halving_nodes(count / 2, kLeafSize);
  parallel_halves(
      threads, [&](unsigned share) { split(node + 1, begin, middle, centroids, share); },
      [&](unsigned share) { split(second, middle, end, centroids, share); });
  const Box &left = nodes_[node + 1].box, &right = nodes_[second].box;
  nodes_[node] = {{lower(left.low, right.low), upper(left.high, right.high)}, second, 0};
}

std::uint32_t RayShooter::first_exit_below(std::uint32_t vertex, const Vec3& d,
                                           const std::function<bool(std::uint32_t)>& accept) const {
  for (double slack : {1e-12, 1e-9, 1e-6}) {
    const std::uint32_t found = first_exit_with_slack(vertex, d, accept, slack);
    if (found != kNone) return found;
  }
  return kNone;
}

std::uint32_t RayShooter::first_exit_with_slack(std::uint32_t vertex, const Vec3& d,
                                                const std::function<bool(std::uint32_t)>& accept,
                                                double slack) const {
  const Vec3 origin = mesh_.points[vertex], ray = -d;
  std::uint32_t best = kNone;
  double best_s = kInfinity;
  std::array<std::uint32_t, 128> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth != 0) {
    const std::uint32_t inner = stack[--depth];
    const Node& node = nodes_[inner];
    double near = 0, far = best_s;
    clip_slab(origin.x, ray.x, node.box.low.x, node.box.high.x, slack, near, far);
    clip_slab(origin.y, ray.y, node.box.low.y, node.box.high.y, slack, near, far);
    clip_slab(origin.z, ray.z, node.box.low.z, node.box.high.z, slack, near, far);
    if (near > far) continue;
    if (node.count == 0) {
      stack[depth++] = inner + 1;
      stack[depth++] = node.first;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t t = triangles_[i];
      const Triangle& corner = mesh_.triangles[t];
      if (corner[0] == vertex || corner[1] == vertex || corner[2] == vertex || !accept(t)) continue;
      const Vec3 &a = mesh_.points[corner[0]], &b = mesh_.points[corner[1]], &c = mesh_.points[corner[2]];
      if (!(dot(cross(b - a, c - a), d) < 0)) continue;
      const double s = hit(origin, ray, a, b, c, slack);
      if (s < 0 || s == kInfinity || s > best_s || (s == best_s && t > best)) continue;
      best = t;
      best_s = s;
    }
  }
  return best;
}

}  // namespace affskel::core
