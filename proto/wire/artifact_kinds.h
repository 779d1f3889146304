#pragma once

#include <span>
#include <string>
#include <string_view>

#include "affskel/v1/client_service.pb.h"
#include "affskel/v1/worker_service.pb.h"

namespace affskel::wire {

/// What an artefact is a function of, besides the job's mesh and erosion parameters.
enum class ArtifactParams {
  kNone,
  kSkeleton,  ///< v1::SkeletonParams
  kOperator,  ///< v1::SkeletonParams, of which only the operator counts
  kSurface,   ///< v1::SurfaceParams
  kEroded,    ///< v1::ErodedParams
  kCurve,     ///< v1::SkeletonParams of CURVE
};

/// What of a job can be fetched.
struct ArtifactKindInfo {
  v1::ArtifactKind kind;
  ArtifactParams params;
  /// That computes it: PREPARE, ERODE and REFINE on the way of a job, the others from the finished field, for
  /// those that ask.  UNSPECIFIED for the mesh and its source, which are given.
  v1::TaskKind task;
  /// Full name of the serialized message; empty for bytes that are described with ArtifactKind.
  std::string_view message;

  /// Made by a task of its own from the finished field.
  bool derived() const;
  /// wire::word(kind): in the database, in messages.
  std::string name() const;
};

/// The one table of them, in the protocol's order.
std::span<const ArtifactKindInfo> artifact_kinds();

/// The row of a kind; null when it is unspecified or unknown.
const ArtifactKindInfo* find_artifact_kind(v1::ArtifactKind kind);

/// The row of the derived kind that a task makes; null for PREPARE, ERODE, REFINE and unknown ones.
const ArtifactKindInfo* find_derived_kind(v1::TaskKind task);

/// The artefact that a job's own skeleton is: SURFACE for an operator that gives a sheet or lines, else SKELETON.
const ArtifactKindInfo& own_skeleton_kind(v1::Operator of_job);

/// Parameters of a derived artefact in canonical form.
struct CanonicalParams {
  std::string bytes;  ///< the serialized message
  std::string key;    ///< equal keys, equal artefacts
};

/// The parameters of a request for a derived artefact, what is absent taken from the job.
/// @param job_skeleton the job's own, canonical.
/// @throws std::invalid_argument, with a message for people, when a value is out of its range.
CanonicalParams artifact_params(const ArtifactKindInfo& kind, const v1::FetchArtifactRequest& request,
                                const v1::SkeletonParams& job_skeleton);

/// Parameters that would be ignored are a mistake of the caller.
/// @throws std::invalid_argument that names them, and the kinds that they are for; also for an unknown kind.
void check_request(const v1::FetchArtifactRequest& request);

/// Puts stored parameters where the task's worker looks for them.  @returns whether they can be read.
bool set_task_params(ArtifactParams params, const std::string& bytes, v1::Lease& lease);

}  // namespace affskel::wire
