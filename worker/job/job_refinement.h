#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/erosion/field.h"
#include "core/infimum/piece_input.h"
#include "core/infimum/refinement.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"
#include "wire/refined_record.h"

namespace affskel::worker {

/// Mesh units per scaled unit of a solid: powers of two, so that values go over and back without rounding.
struct SolidUnits {
  double volume = 1;  ///< cubed
  double area = 1;    ///< squared
};

/// A value as the server has it: E is greater than 0, see PreparedJob::record.
wire::RefinedRecord refined_record(const core::LeastChord& least, const SolidUnits& units,
                                   std::uint32_t round);

/// The other way round; the area, which no later round looks at, is not known.
core::LeastChord least_chord(const wire::RefinedRecord& record, const SolidUnits& units);

/// A job's refinement as far as this worker has heard what was found.
class JobRefinement {
 public:
  /// Both must outlive it.
  JobRefinement(const core::Solid& solid, const core::Lattice& lattice, const SolidUnits& units,
                unsigned threads);

  core::Refinement& rounds() { return rounds_; }
  const SolidUnits& units() const { return units_; }

  /// The seeds of round 0, scaled units; empty until take_seeds().
  const std::vector<core::FieldValue>& seeds() const { return seeds_; }
  /// @param stored the field over the set, see ARTIFACT_KIND_FIELD.  @throws core::CoreError kInternal as below.
  void take_seeds(std::string_view stored);

  /// The round up to which it has what was found; none: nothing.
  const std::optional<std::uint32_t>& known() const { return known_; }
  /// @param stored what the server sends of REFINED: the whole field, or once something is known what came since.
  /// @throws core::CoreError kInternal when it does not fit the job.
  void take_found(std::string_view stored, std::uint32_t through);

 private:
  void set(std::uint64_t point, const wire::RefinedRecord& record);

  const SolidUnits units_;
  const core::PieceInput input_;
  core::Refinement rounds_;
  std::vector<core::FieldValue> seeds_;
  std::optional<std::uint32_t> known_;
};

}  // namespace affskel::worker
