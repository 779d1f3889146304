#include "core/curve/hanging_patches.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/cheapest_ways.h"
#include "core/base/disjoint_sets.h"
#include "core/base/none.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

struct Patch {
  std::int64_t euler = 0;
  std::uint32_t lines = 0, root = 0;  // segments that meet it, and a vertex where one does
  double width = 0, way = 0;
  std::uint32_t end = 0;
  bool has_end = false;
};

class Patches {
 public:
  Patches(const SheetMesh& sheet, std::span<const double> ball, std::span<const char> has_end)
      : sheet_(sheet),
        ball_(ball),
        has_end_(has_end),
        sets_(sheet.vertices.size()),
        on_patch_(sheet.vertices.size(), 0) {
    const Edges edges(sheet.vertices.size(), sheet.triangles);
    edges.for_each([&](std::uint32_t a, std::uint32_t b, std::span<const EdgeSide> sides) {
      edges_.push_back({a, b});
      if (sides.size() == 1) rim_.push_back({a, b});
      sets_.unite(a, b);
      on_patch_[a] = on_patch_[b] = 1;
    });
    neighbours_ = neighbours(sheet.vertices.size(), edges_);
  }

  std::vector<HangingPatch> run() {
    count();
    measure();
    std::vector<HangingPatch> result;
    for (const auto& [first, patch] : patches_)
      if (patch.lines == 1 && patch.euler == 1 && !patch.has_end) result.push_back({patch.end, patch.width});
    return result;
  }

 private:
  Patch& patch_of(std::uint32_t vertex) { return patches_[sets_.find(vertex)]; }

  void count() {
    for (std::uint32_t v = 0; v < on_patch_.size(); ++v)
      if (on_patch_[v]) {
        ++patch_of(v).euler;
        if (has_end_[v]) patch_of(v).has_end = true;
      }
    for (const Segment& edge : edges_) --patch_of(edge[0]).euler;
    for (const Triangle& t : sheet_.triangles) ++patch_of(t[0]).euler;
    for (const Segment& segment : sheet_.segments) {
      for (const std::uint32_t v : segment) {
        if (!on_patch_[v]) continue;
        Patch& patch = patch_of(v);
        ++patch.lines;
        patch.root = v;
      }
    }
  }

  void measure() {
    std::vector<std::uint32_t> rim(on_patch_.size(), kNone), roots = rim;
    for (const Segment& edge : rim_)
      for (const std::uint32_t v : edge) rim[v] = v;
    for (const auto& [first, patch] : patches_)
      if (patch.lines > 0) roots[patch.root] = patch.root;
    const std::vector<double> in = distances(std::move(rim)), out = distances(std::move(roots));
    for (std::uint32_t v = 0; v < on_patch_.size(); ++v) {
      if (!on_patch_[v]) continue;
      Patch& patch = patch_of(v);
      patch.width = std::max(patch.width, in[v] + ball_[v]);
      if (patch.lines == 0 || out[v] <= patch.way) continue;
      patch.way = out[v];
      patch.end = v;
    }
  }

  // Along the surface.
  std::vector<double> distances(std::vector<std::uint32_t> from) const {
    CheapestWays ways(std::move(from));
    ways.find([&](std::uint32_t v, const auto& go) {
      for (const std::uint32_t to : neighbours_[v])
        go(to, norm(sheet_.vertices[to].position - sheet_.vertices[v].position), v);
    });
    return std::move(ways.cost);
  }

  const SheetMesh& sheet_;
  std::span<const double> ball_;
  std::span<const char> has_end_;
  DisjointSets sets_;  // of vertices, by triangles
  std::vector<char> on_patch_;
  std::vector<Segment> edges_, rim_;  // of triangles, each once; those of one
  Adjacency neighbours_;
  std::map<std::uint32_t, Patch> patches_;
};

}  // namespace

std::vector<HangingPatch> hanging_patches(const SheetMesh& sheet, std::span<const double> ball,
                                          std::span<const char> has_end) {
  return Patches(sheet, ball, has_end).run();
}

}  // namespace affskel::core
