#include "core/mesh/laplacian.h"

#include <cstddef>
#include <cstdint>

namespace affskel::core {
namespace {

// The point itself where there are none.
std::vector<Vec3> means_of_neighbours(const Mesh& mesh) {
  std::vector<Vec3> mean(mesh.points.size());
  std::vector<std::uint32_t> count(mesh.points.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {  // every edge is met once in this direction
      mean[t[k]] = mean[t[k]] + mesh.points[t[(k + 1) % 3]];
      ++count[t[k]];
    }
  }
  for (std::size_t v = 0; v < mean.size(); ++v)
    mean[v] = count[v] == 0 ? mesh.points[v] : (1.0 / count[v]) * mean[v];
  return mean;
}

}  // namespace

void smooth(Mesh& mesh, int times) {
  for (; times > 0; --times) {
    const std::vector<Vec3> means = means_of_neighbours(mesh);
    for (std::size_t v = 0; v < means.size(); ++v) mesh.points[v] = 0.5 * (mesh.points[v] + means[v]);
  }
}

}  // namespace affskel::core
