#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"
#include "rows.h"

namespace affskel::bench {

/// What one run of a job cost, seconds.
struct JobCost {
  double prepare_s = 0;  ///< from the OFF text to the first direction
  double trees_s = 0;    ///< thread time in join trees
  double sweep_s = 0;    ///< thread time in sweeps
  double wall_s = 0;     ///< all of it
  double cpu_s = 0;      ///< processor time of the directions, all threads
  core::SweepCounts counts;
};

/// One stretch of a job's directions, seconds.
struct Batch {
  double trees_s = 0, sweep_s = 0;  ///< wall time in trees and sweeps
  double wall_s = 0;
  double cpu_s = 0;  ///< processor time, at most wall_s on one thread

  /// Processor time of a part of its wall time: what others took of the time is shared out evenly.
  double cpu_of(double part_s) const { return wall_s > cpu_s ? part_s * (cpu_s / wall_s) : part_s; }
};

/// Replaces every batch of `best` by that of `now` when this took less time, which is when it was disturbed
/// less.  An empty `best` becomes `now`.
void keep_fastest(std::vector<Batch>& best, const std::vector<Batch>& now);

/// Processor seconds in trees and in sweeps, all batches.
double trees_cpu(const std::vector<Batch>& batches);
double sweep_cpu(const std::vector<Batch>& batches);

/// A row's computation, as `affskel-worker compute` does it: read, check, lattice, directions, erosion.
class Job {
 public:
  /// Prepares it.
  /// @throws CoreError and std::runtime_error when the file cannot be read or is no solid.
  Job(const std::string& off_file, const RowSpec& row, unsigned threads, bool prune = true);

  /// Works through the directions [begin, end) of list().
  void run(std::size_t begin, std::size_t end);
  void run() { run(0, list_.size()); }

  /// The same in at most 256 stretches, each with its times.  For one thread.
  std::vector<Batch> run_in_batches(std::size_t begin, std::size_t end);

  /// What preparing and the runs so far cost.
  const JobCost& cost() const { return cost_; }

  const core::Solid& solid() const { return solid_; }
  const core::Lattice& lattice() const { return lattice_; }
  const core::DirectionSet& directions() const { return directions_; }

  /// The directions to work on, in the service's order, of which a row with max_directions takes the
  /// first: a stretch from all over the set.
  const std::vector<std::uint32_t>& list() const { return list_; }

 private:
  double started_;
  core::Solid solid_;
  core::Lattice lattice_;
  core::DirectionSet directions_;
  std::vector<std::uint32_t> list_;
  std::unique_ptr<core::Erosion> erosion_;
  JobCost cost_;
};

}  // namespace affskel::bench
