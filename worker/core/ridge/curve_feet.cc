#include "core/ridge/curve_feet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/unit.h"

namespace affskel::core {
namespace {

// The nearest of points, by their order along the axis on which they reach farthest.
class NearestVertex {
 public:
  explicit NearestVertex(const std::vector<CurveVertex>& vertices) : vertices_(vertices) {
    double widest = -1;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax_element(
          vertices.begin(), vertices.end(),
          [k](const CurveVertex& a, const CurveVertex& b) { return a.position[k] < b.position[k]; });
      const double extent = high->position[k] - low->position[k];
      if (extent > widest) axis_ = k;
      widest = std::max(widest, extent);
    }
    for (std::uint32_t v = 0; v < vertices.size(); ++v) order_.emplace_back(vertices[v].position[axis_], v);
    std::sort(order_.begin(), order_.end());
  }

  // The nearest vertex of the part and its distance; kNoVertex when there is none.
  std::pair<std::uint32_t, double> of(const Vec3& place, std::uint32_t part) const {
    std::pair<std::uint32_t, double> best{kNoVertex, std::numeric_limits<double>::infinity()};
    const auto take = [&](const std::pair<double, std::uint32_t>& entry) {
      if (std::abs(entry.first - place[axis_]) > best.second) return false;
      const CurveVertex& v = vertices_[entry.second];
      const double away = norm(v.position - place);
      if (v.part == part && std::pair{away, entry.second} < std::pair{best.second, best.first})
        best = {entry.second, away};
      return true;
    };
    const auto middle = std::lower_bound(order_.begin(), order_.end(), std::pair{place[axis_], 0U});
    for (auto after = middle; after != order_.end() && take(*after);) ++after;
    for (auto before = middle; before != order_.begin() && take(*(before - 1));) --before;
    return best;
  }

 private:
  const std::vector<CurveVertex>& vertices_;
  int axis_ = 0;
  std::vector<std::pair<double, std::uint32_t>> order_;
};

}  // namespace

std::vector<CurveVertex> curve_vertices(std::span<const RidgeCurve> curves) {
  std::vector<CurveVertex> result;
  for (std::uint32_t s = 0; s < curves.size(); ++s) {
    const RidgeCurve& curve = curves[s];
    const std::size_t first = result.size();
    double arc = 0;
    for (std::size_t v = 0; v < curve.vertices.size(); ++v) {
      const Vec3& at = curve.vertices[v].position;
      if (v > 0) arc += norm(at - curve.vertices[v - 1].position);
      result.push_back({at, curve.radius[v], arc, s, curve.part, {}});
    }
    if (curve.closed) continue;
    result[first].outward = unit(result[first].position - result[first + 1].position);
    result.back().outward = unit(result.back().position - result[result.size() - 2].position);
  }
  return result;
}

std::vector<CurveFoot> curve_feet(const SheetMesh& mesh, const std::vector<CurveVertex>& curves,
                                  double reach) {
  std::vector<CurveFoot> feet(mesh.vertices.size());
  if (curves.empty()) return feet;
  const NearestVertex nearest(curves);
  for (std::size_t v = 0; v < feet.size(); ++v) {
    const auto [at, away] = nearest.of(mesh.vertices[v].position, mesh.part[v]);
    if (at == kNoVertex) continue;
    const CurveVertex& c = curves[at];
    const bool beyond = dot(mesh.vertices[v].position - c.position, c.outward) > 0;
    const bool within = away <= reach * c.radius;
    feet[v].sideways = !within && !beyond;
    if (within) {
      feet[v].vertex = at;
      feet[v].place = beyond ? CurveFoot::Place::kBeyondEnd : CurveFoot::Place::kBeside;
    }
  }
  return feet;
}

bool is_beside(const std::vector<CurveFoot>& feet, const std::vector<CurveVertex>& curves,
               const Triangle& triangle) {
  for (const std::uint32_t corner : triangle) {
    if (feet[corner].place != CurveFoot::Place::kBeside ||
        curves[feet[corner].vertex].stretch != curves[feet[triangle[0]].vertex].stretch)
      return false;
  }
  return true;
}

}  // namespace affskel::core
