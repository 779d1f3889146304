#include "core/tidy/loose_vertices.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace affskel::core {
namespace {

/// What the triangles round a vertex say.
struct Surroundings {
  Vec3 sum;     // of the neighbours
  Vec3 normal;  // outward, not of unit length
  double count = 0;
};

/// Only triangles of loose vertices matter.
std::vector<Triangle> loose_triangles(std::span<const LooseVertex> loose, const Mesh& mesh) {
  std::vector<std::uint8_t> is_loose(mesh.points.size(), 0);
  for (const LooseVertex& l : loose) is_loose[l.vertex] = 1;
  std::vector<Triangle> result;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(), std::back_inserter(result),
               [&](const Triangle& t) { return is_loose[t[0]] + is_loose[t[1]] + is_loose[t[2]] > 0; });
  return result;
}

void relax(const Surroundings& around, LooseVertex& loose) {
  const double rise = dot(loose.along, around.normal);
  // Where a line runs along the surface, their meeting point is ill-defined.
  constexpr double kMinSine = 0.2;
  if (around.count == 0 || !(rise * rise > kMinSine * kMinSine * dot(loose.along, loose.along) *
                                               dot(around.normal, around.normal))) {
    return;
  }
  const Vec3 mean = (1 / around.count) * around.sum;
  const double wanted = dot(mean - loose.from, around.normal) / rise;
  loose.share = std::clamp(0.5 * (loose.share + wanted), loose.min_share, loose.max_share);
}

}  // namespace

void relax_loose_vertices(std::span<LooseVertex> loose, int rounds, Mesh& mesh, ExecutionContext* context) {
  const std::vector<Triangle> triangles = loose_triangles(loose, mesh);
  std::vector<Surroundings> around(mesh.points.size());
  for (int round = 0; round < rounds; ++round) {
    throw_if_stopped(context);
    for (const LooseVertex& l : loose) {
      mesh.points[l.vertex] = l.from + l.share * l.along;
      around[l.vertex] = {};
    }
    for (const Triangle& t : triangles) {
      const Vec3 normal = twice_area(mesh, t);
      for (std::size_t k = 0; k < 3; ++k) {  // every edge is met once in this direction
        Surroundings& here = around[t[k]];
        here.sum = here.sum + mesh.points[t[(k + 1) % 3]];
        here.normal = here.normal + normal;
        ++here.count;
      }
    }
    for (LooseVertex& l : loose) relax(around[l.vertex], l);
  }
  for (const LooseVertex& l : loose) mesh.points[l.vertex] = l.from + l.share * l.along;
}

}  // namespace affskel::core
