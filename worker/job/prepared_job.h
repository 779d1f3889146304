#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "affskel/v1/types.pb.h"
#include "core/base/matrix3.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"
#include "job/job_refinement.h"
#include "wire/field_record.h"

namespace affskel::worker {

/// A job's mesh read, its lattice laid and its directions made: a function of the bytes, the parameters
/// and the core version alone, so any worker can make it again.  The erosion keeps references into the
/// members: neither copied nor moved.
class PreparedJob {
 public:
  /// @param context asked whether to stop; may be null.
  /// @param available tells the bytes that may be taken, see available_memory; none: no bound.
  /// @param derive_bytes of what is derived, bytes per point: what is computed for weeks must not be too large then.
  /// @throws core::CoreError kBadInput when the mesh or a parameter is wrong; kCancelled when the context
  ///   asks to stop; kLimit when lattice and erosion, or lattice and what is derived, would take more than is available.
  PreparedJob(std::string_view mesh_bytes, const v1::ErosionParams& params, unsigned threads = 1,
              core::ExecutionContext* context = nullptr,
              const std::function<std::uint64_t()>& available = nullptr, double derive_bytes = 0);
  PreparedJob(const PreparedJob&) = delete;
  PreparedJob& operator=(const PreparedJob&) = delete;

  const core::Solid& solid() const { return solid_; }
  const core::Lattice& lattice() const { return lattice_; }
  const core::DirectionSet& directions() const { return directions_; }

  v1::PreparedSummary summary() const;
  v1::Lattice lattice_message() const;
  v1::Directions directions_message() const;

  /// The field's engine, made at the first call; its field starts from `stored`, the server's bytes of the
  /// field merged so far (see ARTIFACT_KIND_FIELD), which is used only then.
  core::Erosion& erosion(unsigned threads, std::string_view stored);
  bool has_erosion() const { return erosion_ != nullptr; }

  /// Lets go what is known of the field; what follows from the mesh stays.
  void forget_field() {
    erosion_.reset();
    refinement_.reset();
  }

  /// Its refinement, made at the first call; the field's engine is not needed from then on and let go.
  JobRefinement& refinement(unsigned threads);
  bool has_refinement() const { return refinement_ != nullptr; }

  /// Mesh units cubed per scaled unit cubed, and squared.
  double volume_unit() const { return volume_unit_; }
  double area_unit() const { return area_unit_; }

  /// A value as the server has it.  E is greater than 0 inside: where nothing that doubles resolve is left,
  /// at a tip, it is the least normal number.
  wire::FieldRecord record(const core::FieldValue& value) const;

 private:
  std::uint64_t polygons_cut_ = 0;  // before solid_, whose making sets it
  core::Solid solid_;
  double volume_unit_, area_unit_;
  core::Matrix3 frame_;
  core::Lattice lattice_;
  core::DirectionSet directions_;
  std::unique_ptr<core::Erosion> erosion_;
  std::unique_ptr<JobRefinement> refinement_;
};

/// A field in the server's form, unpacked: E in mesh units cubed.
/// @throws core::CoreError kInternal when the number of bytes does not fit `points`.
std::vector<core::FieldValue> unpack_field(std::string_view bytes, std::uint64_t points);

}  // namespace affskel::worker
