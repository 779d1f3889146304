#include "core/ridge/ridge_crossings.h"

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/matrix3.h"
#include "core/base/parallel.h"
#include "core/base/unit.h"

namespace affskel::core {
namespace {

// At the share t of an edge with the ends x and y.
RidgeCrossing crossing_at(const Lattice& lattice, const RidgeValues& values, const LatticeEdge& edge,
                          std::uint32_t y, double t, const Vec3& across) {
  const Vec3 place = vector_of(edge.place) + t * kIdentity3[edge.axis];
  RidgeCrossing crossing;
  crossing.edge = edge;
  crossing.normal = unit(across);
  crossing.at = values.at(RidgeValues::Of::kSurface, lattice.spacing * place,
                          std::array<std::uint32_t, 2>{edge.point, y}, std::array<double, 2>{1 - t, t},
                          crossing.normal);
  return crossing;
}

// Leaves those that are far enough from the surface.
void keep_deep(const RidgeValues& values, unsigned threads, std::deque<RidgeCrossing>& crossings) {
  std::vector<char> deep(crossings.size());
  parallel_ranges(threads, crossings.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) deep[n] = values.is_deep(crossings[n].at);
  });
  std::size_t kept = 0;
  for (std::size_t n = 0; n < deep.size(); ++n)
    if (deep[n]) crossings[kept++] = crossings[n];
  crossings.resize(kept);
}

}  // namespace

std::deque<RidgeCrossing> ridge_crossings(const Lattice& lattice, const RidgeValues& values,
                                          unsigned threads) {
  std::deque<RidgeCrossing> result;  // while a vector grows it takes three times its memory
  for_each_edge(lattice, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto& place) {
    const PointRidge &at_x = values.ridge(x), &at_y = values.ridge(y);
    if (at_x.least >= 0 || at_y.least >= 0) return;
    const Vec3 e_x = vector_of(at_x.across);
    const Vec3 e_y = vector_of(at_y.across);
    const double turn = dot(e_x, e_y) < 0 ? -1 : 1;
    const double slope_x = dot(e_x, values.gradient(x));
    const double slope_y = turn * dot(e_y, values.gradient(y));
    if ((slope_x < 0) == (slope_y < 0)) return;
    const double t = slope_x / (slope_x - slope_y);
    const RidgeCrossing crossing =
        crossing_at(lattice, values, {x, axis, place}, y, t, (1 - t) * e_x + (t * turn) * e_y);
    if (values.is_strong(crossing.at)) result.push_back(crossing);
  });
  keep_deep(values, threads, result);
  return result;
}

}  // namespace affskel::core
