#include "core/ridge/ridge_holes.h"

#include <algorithm>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

// A closed walk along a rim, each vertex once.
using Loop = std::vector<std::uint32_t>;

// Walks along the rim; whenever a walk comes back to one of its own vertices, what lies between is a loop.
class RimWalk {
 public:
  explicit RimWalk(const SheetMesh& mesh) {
    Edges(mesh.vertices.size(), mesh.triangles)
        .for_each([&](std::uint32_t low, std::uint32_t high, std::span<const EdgeSide> sides) {
          if (sides.size() != 1) return;
          open_[low].push_back(high);
          open_[high].push_back(low);
        });
  }

  std::vector<Loop> loops() {
    for (auto& [start, ends] : open_)
      while (!ends.empty()) walk(start);
    return std::move(found_);
  }

 private:
  void walk(std::uint32_t start) {
    Loop way{start};
    std::map<std::uint32_t, std::size_t> place{{start, 0}};
    for (std::uint32_t at = start; !open_[at].empty();) {
      const std::uint32_t to = open_[at].front();
      take(at, to);
      take(to, at);
      const auto [known, fresh] = place.try_emplace(to, way.size());
      if (fresh) {
        way.push_back(to);
      } else {
        const auto first = static_cast<std::ptrdiff_t>(known->second) + 1;
        found_.emplace_back(way.begin() + first - 1, way.end());
        for (auto v = way.begin() + first; v != way.end(); ++v) place.erase(*v);
        way.erase(way.begin() + first, way.end());
      }
      at = to;
    }
  }

  void take(std::uint32_t from, std::uint32_t to) {
    std::vector<std::uint32_t>& ends = open_[from];
    ends.erase(std::find(ends.begin(), ends.end(), to));
  }

  std::map<std::uint32_t, std::vector<std::uint32_t>> open_;  // rim edges not walked yet
  std::vector<Loop> found_;
};

double length_of(const SheetMesh& mesh, const Loop& loop) {
  double sum = 0;
  for (std::size_t n = 0; n < loop.size(); ++n)
    sum += norm(mesh.vertices[loop[(n + 1) % loop.size()]].position - mesh.vertices[loop[n]].position);
  return sum;
}

SheetVertex middle_of(const SheetMesh& mesh, const Loop& loop) {
  SheetVertex middle = mesh.vertices[loop[0]];
  // The running mean: each vertex takes its share of those so far.
  for (std::size_t n = 1; n < loop.size(); ++n)
    middle = between(middle, mesh.vertices[loop[n]], 1 / static_cast<double>(n + 1));
  return middle;
}

class Closing {
 public:
  Closing(SheetMesh& mesh, const std::function<bool(const Vec3&)>& inside, double max_share)
      : mesh_(mesh), inside_(inside), max_share_(max_share), sets_(mesh.vertices.size()) {
    for (const Triangle& t : mesh.triangles) {
      sets_.unite(t[0], t[1]);
      sets_.unite(t[0], t[2]);
    }
    area_.assign(mesh.vertices.size(), 0);
    for (const Triangle& t : mesh.triangles) area_[sets_.find(t[0])] += triangle_area(mesh, t);
  }

  std::uint32_t run() {
    std::vector<Loop> loops = RimWalk(mesh_).loops();
    std::map<std::uint32_t, double> longest;  // by piece
    for (const Loop& loop : loops) {
      double& length = longest[sets_.find(loop[0])];
      length = std::max(length, length_of(mesh_, loop));
    }
    std::uint32_t closed = 0;
    for (const Loop& loop : loops)
      if (length_of(mesh_, loop) < longest[sets_.find(loop[0])] && close(loop)) ++closed;
    return closed;
  }

 private:
  bool close(const Loop& loop) {
    const SheetVertex middle = middle_of(mesh_, loop);
    double fan = 0;
    for (std::size_t n = 0; n < loop.size(); ++n) {
      const Vec3 &a = mesh_.vertices[loop[n]].position,
                 &b = mesh_.vertices[loop[(n + 1) % loop.size()]].position;
      fan += 0.5 * norm(cross(a - middle.position, b - middle.position));
      if (!inside_(0.5 * (a + middle.position))) return false;
    }
    if (fan > max_share_ * area_[sets_.find(loop[0])] || !inside_(middle.position)) return false;
    const auto centre = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(middle);
    mesh_.part.push_back(mesh_.part[loop[0]]);
    for (std::size_t n = 0; n < loop.size(); ++n)
      mesh_.triangles.push_back({loop[n], loop[(n + 1) % loop.size()], centre});
    return true;
  }

  SheetMesh& mesh_;
  const std::function<bool(const Vec3&)>& inside_;
  double max_share_;
  DisjointSets sets_;         // pieces, of the vertices before any was added
  std::vector<double> area_;  // per piece
};

}  // namespace

std::uint32_t close_holes(SheetMesh& mesh, const std::function<bool(const Vec3&)>& inside, double max_share) {
  return Closing(mesh, inside, max_share).run();
}

}  // namespace affskel::core
