#include "core/ridge/local_thickness.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/none.h"
#include "core/base/parallel.h"

namespace affskel::core {
namespace {

constexpr float kHolds = 1.5F;  // of a ball's radius: sqrt(2) reaches from a plate's middle to its edge

// A sample point, and how many spacings it lies from where the way began.
struct Walk {
  std::uint32_t point = kNone;
  std::array<int, 3> steps{};
};

class Ways {
 public:
  Ways(const DualComplex& complex, std::span<const float> distance)
      : complex_(complex), distance_(distance) {}

  // To the greatest of the six neighbours; where none is greater, as on an edge, of what three steps lead to.
  float greatest_from(std::uint32_t point) const {
    Walk at{point, {}};
    for (;;) {
      Walk best = at;
      look_round(at, 1, best);
      if (best.point == at.point) look_round(at, 3, best);
      if (best.point == at.point) return distance_[at.point];
      at = best;
    }
  }

 private:
  void look_round(const Walk& at, int steps, Walk& best) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const std::uint32_t digit : {0U, 2U}) {
        Walk next{complex_.neighbour(at.point, axis, digit), at.steps};
        if (next.point == kNone) continue;
        next.steps[axis] += static_cast<int>(digit) - 1;
        take(next, best);
        if (steps > 1) look_round(next, steps - 1, best);
      }
  }

  void take(const Walk& next, Walk& best) const {
    const float radius = distance_[next.point];
    if (radius <= distance_[best.point]) return;
    const auto& [i, j, k] = next.steps;
    if (std::sqrt(static_cast<float>(i * i + j * j + k * k)) <= kHolds * radius) best = next;
  }

  const DualComplex& complex_;
  std::span<const float> distance_;
};

}  // namespace

std::vector<float> local_thickness(const DualComplex& complex, std::span<const float> distance,
                                   std::span<const std::uint32_t> points,
                                   const LocalThicknessOptions& options) {
  const Ways ways(complex, distance);
  std::vector<float> result(points.size(), std::numeric_limits<float>::infinity());
  parallel_ranges(options.threads, points.size(), [&](std::size_t begin, std::size_t end) {
    StopCheck stop(options.context);
    for (std::size_t n = begin; n < end; ++n, stop.did(1000))
      if (points[n] != kNone) result[n] = ways.greatest_from(points[n]);
  });
  return result;
}

}  // namespace affskel::core
