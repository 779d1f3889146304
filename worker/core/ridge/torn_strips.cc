// T, E, V: the numbers of triangles, edges and corners of what lies in a window, C that of its pieces.  Its
// tunnels less its closed pockets are C - (V - E + T).
#include "core/ridge/torn_strips.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/mesh/edges.h"
#include "core/ridge/curve_feet.h"
#include "core/ridge/round_stretches.h"

namespace affskel::core {
namespace {

bool is_torn(std::vector<Triangle> triangles) {
  if (triangles.empty()) return true;
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  for (Triangle& t : triangles) {
    for (std::uint32_t& corner : t)  // its place among all
      corner = static_cast<std::uint32_t>(std::lower_bound(corners.begin(), corners.end(), corner) -
                                          corners.begin());
  }
  DisjointSets sets(corners.size());
  std::size_t pieces = corners.size(), edges = 0;
  Edges(corners.size(), triangles).for_each([&](std::uint32_t low, std::uint32_t high, const auto&) {
    ++edges;
    pieces -= sets.unite(low, high) ? 1 : 0;
  });
  return pieces + edges != corners.size() + triangles.size();
}

// The triangles whose corners all lie beside one stretch.
class TrianglesBeside {
 public:
  TrianglesBeside(const SheetMesh& mesh, const std::vector<CurveVertex>& curve, double reach)
      : mesh_(mesh), feet_(curve_feet(mesh, curve, reach)), at_(curve.size()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (is_beside(feet_, curve, mesh.triangles[t])) at_[feet_[mesh.triangles[t][0]].vertex].push_back(t);
    }
  }

  // Those with all feet on the vertices begin .. end - 1.
  std::vector<Triangle> in(std::uint32_t begin, std::uint32_t end) const {
    std::vector<Triangle> result;
    for (std::uint32_t v = begin; v < end; ++v) {
      for (const std::uint32_t t : at_[v]) {
        const Triangle& corners = mesh_.triangles[t];
        if (std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
              return feet_[corner].vertex >= begin && feet_[corner].vertex < end;
            }))
          result.push_back(corners);
      }
    }
    return result;
  }

 private:
  const SheetMesh& mesh_;
  std::vector<CurveFoot> feet_;
  std::vector<std::vector<std::uint32_t>> at_;  // by the foot of the first corner
};

}  // namespace

std::vector<RidgeCurve> torn_stretches(const SheetMesh& mesh, std::span<const RidgeCurve> stretches,
                                       const RidgeConstants& constants) {
  const std::vector<CurveVertex> curve = curve_vertices(stretches);
  const TrianglesBeside beside(mesh, curve, constants.reach);
  std::vector<RidgeCurve> result;
  std::uint32_t first = 0;  // vertex of the stretch
  for (const RidgeCurve& stretch : stretches) {
    const auto count = static_cast<std::uint32_t>(stretch.vertices.size());
    std::vector<char> wanted(count, 0);
    // The first vertex that lies `radii` or more beyond vertex v.
    const auto beyond = [&](std::uint32_t v, double radii) {
      std::uint32_t at = v + 1;
      while (at < count && curve[first + at].arc - curve[first + v].arc < radii * stretch.radius[v]) ++at;
      return at;
    };
    for (std::uint32_t begin = 0, end = 0; end < count; begin = beyond(begin, constants.step)) {
      end = beyond(begin, constants.window);
      if (is_torn(beside.in(first + begin, first + end)))
        std::fill(wanted.begin() + begin, wanted.begin() + end, char{1});
    }
    for (std::uint32_t v = 0; v < count; ++v)
      if (stretch.vertices[v].ratio >= constants.round_ratio) wanted[v] = 1;
    for (RidgeCurve& part : parts_of_curve(stretch, wanted)) result.push_back(std::move(part));
    first += count;
  }
  return result;
}

}  // namespace affskel::core
