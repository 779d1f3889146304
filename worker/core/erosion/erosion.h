#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/execution_context.h"
#include "core/erosion/directions.h"
#include "core/erosion/field.h"
#include "core/erosion/sweep.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// What an erosion takes in memory for every sample point, bytes: the field and what sweeps know of runs.
constexpr double kErosionBytesPerPoint = 22;

struct ErosionOptions {
  unsigned threads = 1;        ///< >= 1
  bool track_changes = false;  ///< see ErosionField::take_changes
  bool prune = true;           ///< see SweepOptions
};

/// What an erosion cost, added up over threads.
struct ErosionCost {
  double trees_s = 0;  ///< in join trees, wall seconds of each thread
  double sweep_s = 0;  ///< in sweeps, likewise
  SweepCounts counts;
};

/// Computes E(x) = min over directions of chord(x, d) for all sample points of a lattice (Zografos 2003,
/// sections 2.2.2 and 3.3, in the limit of vanishing steps).  Solid, lattice and directions are kept by
/// reference and must outlive it.
class Erosion {
 public:
  Erosion(const Solid& solid, const Lattice& lattice, const DirectionSet& directions,
          const ErosionOptions& options);
  ~Erosion();

  /// Works through `list` (indices into the direction set), several at a time, and tells the context of
  /// each one's place in the list when it is in the field.  Returns early when the context asks to stop.
  /// May be called again; the result is a function of the set of all directions done, not of their order.
  /// @throws CoreError kInternal when an invariant of a tree fails; what was finished stays in the field.
  void run(std::span<const std::uint32_t> list, ExecutionContext& context);

  ErosionField& field();
  ErosionCost cost() const;

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace affskel::core
