#include "core/erosion/place_chords.h"

#include <cmath>

#include "core/base/parallel.h"

namespace affskel::core {
namespace {

// The axis along which heights fall fastest, and whether that is against it.
std::size_t way_down(const Vec3& d) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(d[static_cast<int>(k)]) > std::abs(d[static_cast<int>(axis)])) axis = k;
  }
  return 2 * axis + (d[static_cast<int>(axis)] < 0 ? 1 : 0);
}

}  // namespace

PlaceChords::PlaceChords(const Solid& solid, std::span<const Vec3> places, unsigned threads)
    : places_(places.begin(), places.end()),
      below_(places.size(), kOutside),
      solid_volume_(solid.scaled(solid.volume)) {
  const AxisRays rays(solid.mesh, threads);
  parallel_ranges(threads, places_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Below below;
      bool inside = true;
      for (std::size_t way = 0; way < below.size() && inside; ++way) {
        const AxisRays::Hit hit = rays.shoot(places_[p], static_cast<int>(way / 2), way % 2 == 1);
        inside = hit.winding > 0 && hit.triangle != kNone;
        below[way] = hit.triangle;
      }
      if (inside) below_[p] = below;
    }
  });
}

void PlaceChords::along(const JoinTree& tree, const Vec3& d, std::size_t begin, double margin,
                        std::span<float> chords) const {
  const std::size_t way = way_down(d);
  for (std::size_t i = 0; i < chords.size(); ++i) {
    chords[i] = 0;
    if (!inside(begin + i)) continue;
    const double h = dot(d, places_[begin + i]);
    const Arc& arc = tree.arcs[tree.climb(below_[begin + i][way], h)];
    double volume = tree.locate(arc, h).volume_at(h);
    // As the sweep does: rounding gives small negative volumes, surfaces that cross themselves large ones.
    if (volume < 0) volume = volume < -margin ? solid_volume_ : 0;
    chords[i] = static_cast<float>(volume);
  }
}

}  // namespace affskel::core
