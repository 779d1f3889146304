#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/erosion/field.h"
#include "core/erosion/join_tree.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

struct SweepOptions {
  bool prune = true;        ///< false: evaluate every point (yardstick and test of the pruning; same result)
  double margin = 0;        ///< scaled volume; computed chords may fall along a run by at most this
  double solid_volume = 0;  ///< scaled volume of V: stands for chords that come out negative, see sweep()
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

/// Offers chord(x, d) of all sample points to a field, direction after direction, leaving out points that
/// cannot improve: where the least volume from the first point of a run (or of one of its segments) on
/// upwards, JoinTree::volume_below, exceeds the largest E in it by more than the margin, none of its points
/// can improve.  The field after all directions is the same whatever was pruned.
///
/// Shared by threads: bounds are atomic and may be out of date, which only costs time.
class Sweeper {
 public:
  Sweeper(const Lattice& lattice, ErosionField& field, const SweepOptions& options);

  /// Direction number `index`, unit vector d, with its tree.  Chords are offered to 36 significant bits, so
  /// that those of mirror images, which differ by rounding alone, tie and the index decides.  Chords below
  /// -margin, which only a mesh that crosses itself gives, say nothing: the whole volume is offered for them.
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
