#include "core/ridge/round_stretches.h"

#include <algorithm>
#include <utility>

namespace affskel::core {
namespace {

double distance(const RidgeCurve& curve, std::size_t a, std::size_t b) {
  return norm(curve.vertices[b].position - curve.vertices[a].position);
}

// lambda_2 / lambda_1 averaged over `reach` radii of the vertex to both sides, each place for the length of
// curve that it stands for.
double smoothed_ratio(const RidgeCurve& curve, std::size_t vertex, double reach) {
  const std::size_t count = curve.vertices.size();
  double sum = 0, length = 0;
  const auto walk = [&](std::size_t step) {
    double gone = 0;
    for (std::size_t at = vertex, steps = 1; steps < count && gone < reach * curve.radius[vertex]; ++steps) {
      const std::size_t next = (at + step) % count;
      if (!curve.closed && (step == 1 ? at + 1 == count : at == 0)) break;
      const double piece = distance(curve, at, next);
      sum += 0.5 * piece * (curve.vertices[at].ratio + curve.vertices[next].ratio);
      length += piece;
      gone += piece;
      at = next;
    }
  };
  walk(1);
  walk(count - 1);
  return length > 0 ? sum / length : curve.vertices[vertex].ratio;
}

RidgeCurve section_of(const RidgeCurve& curve, std::size_t first, std::size_t count) {
  RidgeCurve result;
  result.part = curve.part;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t at = (first + n) % curve.vertices.size();
    result.vertices.push_back(curve.vertices[at]);
    result.radius.push_back(curve.radius[at]);
  }
  return result;
}

}  // namespace

std::vector<RidgeCurve> parts_of_curve(const RidgeCurve& curve, const std::vector<char>& wanted) {
  const std::size_t count = wanted.size();
  const auto unwanted = std::find(wanted.begin(), wanted.end(), 0);
  if (unwanted == wanted.end()) return {curve};
  // A closed curve is cut where it is not wanted.
  const std::size_t start = curve.closed ? static_cast<std::size_t>(unwanted - wanted.begin()) : 0;
  std::vector<RidgeCurve> parts;
  for (std::size_t first = 0, last; first < count; first = last + 1) {
    for (last = first; last < count && wanted[(start + last) % count];) ++last;
    if (last >= first + 2) parts.push_back(section_of(curve, start + first, last - first));
  }
  return parts;
}

std::vector<RidgeCurve> round_stretches(std::span<const RidgeCurve> curves, const RidgeBounds& bounds,
                                        const RidgeConstants& constants) {
  std::vector<RidgeCurve> result;
  for (RidgeCurve curve : curves) {
    std::vector<double> ratio(curve.vertices.size());
    for (std::size_t v = 0; v < ratio.size(); ++v) ratio[v] = smoothed_ratio(curve, v, constants.smoothing);
    std::vector<char> wanted(ratio.size());
    for (std::size_t v = 0; v < ratio.size(); ++v) {
      curve.vertices[v].ratio = ratio[v];
      wanted[v] = ratio[v] >= constants.low_ratio && curve.vertices[v].strength >= bounds.low;
    }
    for (RidgeCurve& part : parts_of_curve(curve, wanted)) {
      const auto any = [&](auto test) {
        return std::any_of(part.vertices.begin(), part.vertices.end(), test);
      };
      if (any([&](const SheetVertex& v) { return v.ratio >= constants.high_ratio; }) &&
          any([&](const SheetVertex& v) {
            return v.strength >= bounds.high && v.roundness <= constants.max_roundness;
          }))
        result.push_back(std::move(part));
    }
  }
  return result;
}

}  // namespace affskel::core
