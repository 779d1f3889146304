#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/erosion/directions.h"
#include "core/mesh/mesh.h"
#include "rows.h"

namespace affskel::bench {

/// A yardstick: processor seconds for one direction, and how many directions it was taken from.
struct Yardstick {
  double seconds_per_direction = 0;
  std::uint64_t directions = 0;
};

/// The sort unit: std::sort of N/2 (height, index) pairs.  Heights are those of the mesh's first N/2
/// vertices (a closed surface of genus 1 has just as many) along the first directions of `list`, computed
/// outside the timed part.  A sample of directions that gives about 1.5e6 pairs is sorted `repeats` times
/// over, and the best times count.
Yardstick sort_unit(const core::Mesh& mesh, const core::DirectionSet& directions,
                    std::span<const std::uint32_t> list, int repeats);

/// The sweep without pruning: every chord of every point computed, on a sample of the row's directions
/// that gives about 3e7 chords.  Other directions go first, so that the sample meets a field that hardly
/// improves any more; that is the cheapest a plain sweep can be, and the ratio is on the safe side.
Yardstick plain_sweep(const std::string& off_file, const RowSpec& row, int repeats);

}  // namespace affskel::bench
