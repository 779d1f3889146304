#include "core/ridge/ridge_flaps.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/require.h"

namespace affskel::core {
namespace {

struct Side {
  std::uint32_t low, high;  // the edge's vertices
  std::uint32_t triangle;
  friend auto operator<=>(const Side&, const Side&) = default;
};

class FlapCutter {
 public:
  FlapCutter(RidgeMesh& mesh, double max_share)
      : mesh_(mesh),
        max_share_(max_share),
        patches_(mesh.triangles.size()),
        pieces_(mesh.vertices.size()),
        dropped_(mesh.triangles.size(), 0),
        patch_area_(mesh.triangles.size(), 0),
        piece_area_(mesh.vertices.size(), 0) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& corner = mesh.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(corner[k], corner[(k + 1) % 3]);
        sides_.push_back({low, high, t});
        pieces_.unite(low, high);
      }
    }
    std::sort(sides_.begin(), sides_.end());
    for_each_edge([&](std::size_t first, std::size_t last) {
      if (last - first == 2) patches_.unite(sides_[first].triangle, sides_[first + 1].triangle);
    });
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const double area = triangle_area(mesh, mesh.triangles[t]);
      patch_area_[patches_.find(t)] += area;
      piece_area_[pieces_.find(mesh.triangles[t][0])] += area;
    }
  }

  std::uint32_t run() {
    std::uint32_t count = 0;
    for_each_edge([&](std::size_t first, std::size_t last) {
      if (last - first > 2) count += cut_at(first, last);
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
  template <class Visit>
  void for_each_edge(Visit visit) const {
    for (std::size_t first = 0, last; first < sides_.size(); first = last) {
      for (last = first + 1; last < sides_.size() && sides_[last].low == sides_[first].low &&
                             sides_[last].high == sides_[first].high;)
        ++last;
      visit(first, last);
    }
  }

  // The triangles of one edge: drops the least patches while more than two triangles are left.
  std::uint32_t cut_at(std::size_t first, std::size_t last) {
    std::vector<std::pair<double, std::uint32_t>> here;  // area and patch of each triangle left
    for (std::size_t s = first; s < last; ++s) {
      const std::uint32_t patch = patches_.find(sides_[s].triangle);
      if (!dropped_[patch]) here.emplace_back(patch_area_[patch], patch);
    }
    std::sort(here.begin(), here.end());
    const double bound = max_share_ * piece_area_[pieces_.find(sides_[first].low)];
    std::uint32_t count = 0;
    for (std::size_t n = 0; here.size() - n > 2 && here[n].first <= bound; ++n) {
      if (dropped_[here[n].second]) continue;
      dropped_[here[n].second] = 1;
      ++count;
    }
    return count;
  }

  RidgeMesh& mesh_;
  double max_share_;
  std::vector<Side> sides_;    // ascending
  DisjointSets patches_;       // of triangles
  DisjointSets pieces_;        // of vertices
  std::vector<char> dropped_;  // per patch
  std::vector<double> patch_area_, piece_area_;
};

}  // namespace

std::uint32_t cut_flaps(RidgeMesh& mesh, const RidgeFlapOptions& options) {
  require_within(options.max_share, 0, 1, "the share of a flap must lie between 0 and 1");
  return FlapCutter(mesh, options.max_share).run();
}

}  // namespace affskel::core
