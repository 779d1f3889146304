#include "core/ridge/ridge_flaps.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

using Sides = std::span<const EdgeSide>;

class FlapCutter {
 public:
  FlapCutter(SheetMesh& mesh, double max_share)
      : mesh_(mesh),
        max_share_(max_share),
        edges_(mesh.vertices.size(), mesh.triangles),
        patches_(mesh.triangles.size()),
        pieces_(mesh.vertices.size()),
        dropped_(mesh.triangles.size(), 0),
        patch_area_(mesh.triangles.size(), 0),
        piece_area_(mesh.vertices.size(), 0) {
    edges_.for_each([&](std::uint32_t low, std::uint32_t high, Sides sides) {
      pieces_.unite(low, high);
      if (sides.size() == 2) patches_.unite(sides[0].triangle(), sides[1].triangle());
    });
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const double area = triangle_area(mesh, mesh.triangles[t]);
      patch_area_[patches_.find(t)] += area;
      piece_area_[pieces_.find(mesh.triangles[t][0])] += area;
    }
  }

  std::uint32_t run() {
    std::uint32_t count = 0;
    edges_.for_each([&](std::uint32_t low, std::uint32_t, Sides sides) {
      if (sides.size() > 2) count += cut_at(low, sides);
    });
    if (count == 0) return 0;
    std::size_t kept = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      if (!dropped_[patches_.find(t)]) mesh_.triangles[kept++] = mesh_.triangles[t];
    mesh_.triangles.resize(kept);
    drop_unused_vertices(mesh_);
    return count;
  }

 private:
  // The sides of one edge: drops the least patches while more than two triangles are left.
  std::uint32_t cut_at(std::uint32_t vertex, Sides sides) {
    std::vector<std::pair<double, std::uint32_t>> here;  // area and patch of each triangle left
    for (const EdgeSide& side : sides) {
      const std::uint32_t patch = patches_.find(side.triangle());
      if (!dropped_[patch]) here.emplace_back(patch_area_[patch], patch);
    }
    std::sort(here.begin(), here.end());
    const double bound = max_share_ * piece_area_[pieces_.find(vertex)];
    std::uint32_t count = 0;
    for (std::size_t n = 0; here.size() - n > 2 && here[n].first <= bound; ++n) {
      if (dropped_[here[n].second]) continue;
      dropped_[here[n].second] = 1;
      ++count;
    }
    return count;
  }

  SheetMesh& mesh_;
  double max_share_;
  Edges edges_;
  DisjointSets patches_;       // of triangles
  DisjointSets pieces_;        // of vertices
  std::vector<char> dropped_;  // per patch
  std::vector<double> patch_area_, piece_area_;
};

}  // namespace

std::uint32_t cut_flaps(SheetMesh& mesh, double max_share) {
  return FlapCutter(mesh, max_share).run();
}

}  // namespace affskel::core
