#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_coordinates.h"
#include "derive/known_ridges.h"
#include "job/prepared_job.h"

namespace affskel::worker {

/// What a finished field says, mesh units.
struct FieldValues {
  bool over_set = true;  ///< whether the directions are those of the job's set, by their index
  /// Per sample point; the area is the slope |grad E|.
  std::vector<core::FieldValue> values;
  core::DirectionSet directions;  ///< that the values name
  /// Over all directions, per sample point: core::LeastChord::saddles.
  std::vector<std::array<std::uint32_t, 2>> saddles = {};
};

/// A field over the job's set of directions.
/// @param stored the server's bytes, see ARTIFACT_KIND_FIELD.
/// @throws core::CoreError kInternal when their number does not fit the job; so below.
FieldValues set_field(const PreparedJob& job, std::string_view stored);

/// A field over all directions: each point has one of its own.
/// @param stored see ARTIFACT_KIND_REFINED.
FieldValues refined_field(const PreparedJob& job, std::string_view stored);

/// A job's finished field as the derive tasks look at it.  Keeps a reference to the job.
class FinishedField {
 public:
  /// @param context of the task, may be null; must outlive this.
  /// @param threads that a derivation may use.
  /// @param known of this field, must outlive this; null: nothing is, nor kept.
  FinishedField(const PreparedJob& job, FieldValues field, core::ExecutionContext* context = nullptr,
                unsigned threads = 1, KnownRidges* known = nullptr);
  FinishedField(const FinishedField&) = delete;
  FinishedField& operator=(const FinishedField&) = delete;

  const PreparedJob& job() const { return job_; }
  core::ExecutionContext* context() const { return context_; }
  unsigned threads() const { return threads_; }
  KnownRidges& known() const { return *known_; }
  /// Between the steps of a derivation.  @throws core::CoreError kCancelled when the task is to stop.
  void throw_if_stopped() const { core::throw_if_stopped(context_); }
  const core::Lattice& lattice() const { return job_.lattice(); }
  /// Whether its directions are those of the job's set.
  bool over_set() const { return over_set_; }
  /// Over all directions, per sample point: core::LeastChord::saddles.
  const std::vector<std::array<std::uint32_t, 2>>& saddles() const { return saddles_; }
  /// How many more directions the job's set has than its mesh triangles; 0 where it has fewer.
  std::size_t more_directions() const;
  /// The directions that the values name as unit normals in the lattice's frame.
  const core::DirectionSet& frame_directions() const { return frame_directions_; }
  /// Per sample point, by index; kNoDirection of FieldValue without one.
  const core::OptimalDirections& optimal() const { return in_frame_.direction; }
  /// In the frame's coordinates; E in mesh units.
  const core::FrameField& in_frame() const { return in_frame_; }

  /// Mesh place of a lattice place, and of a point in the frame's coordinates.
  core::Vec3 place(const core::LatticePlace& at) const { return places_.at(at[0], at[1], at[2]); }
  core::Vec3 to_mesh(const core::Vec3& frame_point) const;
  /// A normal of the frame as a unit normal in mesh coordinates.
  core::Vec3 normal_to_mesh(const core::Vec3& frame_normal) const;
  /// A lattice place in the frame's coordinates.
  core::Vec3 in_frame(const core::LatticePlace& at) const;
  /// The optimal normal of a sample point in mesh coordinates; 0 where there is none.
  core::Vec3 normal(std::uint32_t point) const;

 private:
  const PreparedJob& job_;
  core::ExecutionContext* context_;
  unsigned threads_;
  std::unique_ptr<KnownRidges> own_;
  KnownRidges* known_;
  bool over_set_;
  std::vector<std::array<std::uint32_t, 2>> saddles_;
  core::FrameField in_frame_;  // what the values say, kept once
  core::DirectionSet directions_, frame_directions_;
  core::SamplePlaces places_;
};

}  // namespace affskel::worker
