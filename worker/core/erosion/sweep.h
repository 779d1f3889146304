#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/erosion/field.h"
#include "core/erosion/join_tree.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

struct SweepOptions {
  bool prune = true;        ///< false: evaluate every point (to measure and test the pruning; same result)
  double margin = 0;        ///< scaled volume by which computed chords may fall along a run
  double solid_volume = 0;  ///< scaled volume of V, offered for negative chords, see sweep()
};

/// Counts of what sweeps did.
struct SweepCounts {
  std::uint64_t evaluated = 0;  ///< chords computed at single points
  std::uint64_t tested = 0;     ///< chords computed to skip a run or a segment

  SweepCounts& operator+=(const SweepCounts& other) {
    evaluated += other.evaluated;
    tested += other.tested;
    return *this;
  }
};

/// Offers chord(x, d) of all sample points to a field, direction after direction.  Skips points that cannot
/// improve: if JoinTree::volume_below at the first point of a run, or of one of its segments, exceeds the
/// largest E in it by more than the margin, none of its points can.  The field after all directions is the
/// same whatever was skipped.
///
/// Shared by threads: bounds are atomic and may be out of date, which only costs time.
class Sweeper {
 public:
  Sweeper(const Lattice& lattice, ErosionField& field, const SweepOptions& options);

  /// Direction number `index`, unit vector d, with its tree.  Chords are offered with 36 significant bits, so
  /// that those of mirror images, which differ by rounding alone, tie and the index decides.  A chord below
  /// -margin occurs only where a mesh crosses itself, and means nothing: the volume of V is offered instead.
  SweepCounts sweep(const JoinTree& tree, const Vec3& d, std::uint32_t index);

 private:
  struct AxisBounds {
    std::vector<double> run;                   // largest E of the run
    std::vector<double> segment;               // largest E of kSegment consecutive points
    std::vector<std::uint32_t> first_segment;  // per run
  };
  class Pass;

  const Lattice& lattice_;
  ErosionField& field_;
  SweepOptions options_;
  std::array<AxisBounds, 3> bounds_;
};

}  // namespace affskel::core
