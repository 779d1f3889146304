#include "core/curve/lattice_windings.h"

#include <algorithm>
#include <cstddef>
#include <unordered_set>
#include <utility>

#include "core/base/error.h"

namespace affskel::core {
namespace {

std::vector<LatticePlace> places_of(const Lattice& lattice, const std::vector<std::uint32_t>& points) {
  std::vector<std::uint32_t> sorted = points;
  std::sort(sorted.begin(), sorted.end());
  const std::vector<LatticePlace> found = lattice_places(lattice, sorted);
  std::vector<LatticePlace> places;
  places.reserve(points.size());
  for (const std::uint32_t point : points)
    places.push_back(found[static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), point) -
                                                    sorted.begin())]);
  return places;
}

Vec3 indices(const LatticePlace& place) {
  return {static_cast<double>(place[0]), static_cast<double>(place[1]), static_cast<double>(place[2])};
}

}  // namespace

LatticeWindings::LatticeWindings(const Solid& solid, const Lattice& lattice, const DualComplex& complex,
                                 std::vector<std::uint32_t> points)
    : lattice_(lattice), complex_(complex), windings_(solid.mesh), points_(std::move(points)) {
  if (loops() > 0) places_ = places_of(lattice, points_);
}

// In breadth, by steps from the first; the last is the target.
std::vector<LatticeWindings::Step> LatticeWindings::search(std::uint32_t from, std::uint32_t target) const {
  std::vector<Step> steps{{points_[from], 0, places_[from]}};
  std::unordered_set<std::uint32_t> seen{points_[from]};
  for (std::uint32_t n = 0; n < steps.size() && steps.back().cube != target; ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::uint32_t side : {0U, 2U}) {
        const std::uint32_t next = complex_.neighbour(steps[n].cube, axis, side);
        if (next == DualComplex::kNone || !seen.insert(next).second) continue;
        steps.push_back({next, n, steps[n].place});
        steps.back().place[axis] += side - 1;  // below 0 it wraps round, and back
        if (next == target) return steps;
      }
    }
  }
  if (steps.back().cube != target)
    throw CoreError(CoreError::Code::kInternal, "a line leads to another part of the solid");
  return steps;
}

std::vector<double> LatticeWindings::between(std::uint32_t from, std::uint32_t to) const {
  std::vector<double> sum(loops(), 0);
  const std::vector<Step> steps = search(from, points_[to]);
  for (std::size_t n = steps.size() - 1; n != 0; n = steps[n].before) {
    const std::vector<double> part =
        windings_.along(scaled_place(lattice_, indices(steps[steps[n].before].place)),
                        scaled_place(lattice_, indices(steps[n].place)));
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
  }
  return sum;
}

}  // namespace affskel::core
