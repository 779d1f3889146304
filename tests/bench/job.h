#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/directions.h"
#include "core/erosion.h"
#include "core/lattice.h"
#include "core/solid.h"
#include "rows.h"

namespace affskel::bench {

/// What one run of a job cost, seconds.
struct JobCost {
  double prepare_s = 0;      ///< from the OFF text to the first direction
  double trees_s = 0;        ///< thread time in join trees
  double sweep_s = 0;        ///< thread time in sweeps
  double wall_s = 0;         ///< all of it
  double erode_s = 0;        ///< wall time of the directions alone
  double prepare_cpu_s = 0;  ///< processor time of the preparation
  double erode_cpu_s = 0;    ///< processor time of the directions, all threads
  core::SweepCounts counts;
};

/// A row's computation, as `affskel-worker compute` does it: read, check, lattice, directions, erosion.
class Job {
 public:
  /// Prepares it.
  /// @throws CoreError and std::runtime_error when the file cannot be read or is no solid.
  Job(const std::string& off_file, const RowSpec& row, unsigned threads, bool prune = true);

  /// Works through the directions [begin, end) of list().  Returns what the calls so far cost.
  JobCost run(std::size_t begin, std::size_t end);
  JobCost run() { return run(0, list_.size()); }

  const core::Solid& solid() const { return solid_; }
  const core::Lattice& lattice() const { return lattice_; }
  const core::DirectionSet& directions() const { return directions_; }

  /// The directions to work on, in the service's order, of which a row with max_directions takes the
  /// first: a stretch from all over the set.
  const std::vector<std::uint32_t>& list() const { return list_; }

 private:
  double started_, started_cpu_;
  core::Solid solid_;
  core::Lattice lattice_;
  core::DirectionSet directions_;
  std::vector<std::uint32_t> list_;
  std::unique_ptr<core::Erosion> erosion_;
  JobCost cost_;
};

}  // namespace affskel::bench
