#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/none.h"
#include "core/erosion/join_tree.h"
#include "core/solid/solid.h"
#include "core/spatial/axis_rays.h"

namespace affskel::core {

/// Chords of places that need not lie on a lattice: chord(p, d), the volume of the component of
/// { y in V : d.y <= d.p } that holds p, from the join tree of d.  From p the straight way along the axis
/// that falls fastest stays in V up to the first triangle that it meets, so that p's component is that of the
/// triangle's lowest vertex, at p's height; the six triangles of a place are found once.  48 bytes per place.
/// Immutable; threads share it.
class PlaceChords {
 public:
  /// @param places scaled coordinates; kept by copy.
  /// @param threads for the rays.
  PlaceChords(const Solid& solid, std::span<const Vec3> places, unsigned threads = 1);

  std::size_t size() const { return places_.size(); }

  /// Whether a place lies in the solid.  The others have no chords.
  bool inside(std::size_t place) const { return below_[place] != kOutside; }

  /// Writes the chords of the places [begin, begin + chords.size()), scaled volumes rounded to 24 significant
  /// bits, which never changes their order; 0 for places outside.
  /// @param tree of the unit vector d.
  /// @param margin scaled volume by which computed chords may be below 0, see Sweeper::sweep().
  void along(const JoinTree& tree, const Vec3& d, std::size_t begin, double margin,
             std::span<float> chords) const;

 private:
  // The first triangles against and along each axis: [2 axis], [2 axis + 1].
  using Below = std::array<std::uint32_t, 6>;

  static constexpr Below kOutside = {kNone, kNone, kNone, kNone, kNone, kNone};

  std::vector<Vec3> places_;
  std::vector<Below> below_;
  double solid_volume_;  // scaled
};

}  // namespace affskel::core
