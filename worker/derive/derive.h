#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "affskel/v1/worker_service.pb.h"
#include "derive/known_ridges.h"
#include "job/prepared_job.h"

namespace affskel::worker {

/// What a derive task hands in.
struct Derived {
  std::string data;         ///< the artefact, see ArtifactKind
  std::uint64_t items = 0;  ///< points, or vertices of a surface
  std::optional<v1::SkeletonQuality> quality;
};

/// Computes the artefact that the lease asks for from the finished field.
/// @param stored the field's bytes, see ARTIFACT_KIND_FIELD; of a job with the minimum INFIMUM ARTIFACT_KIND_REFINED.
/// @param context asked between the steps whether to stop; may be null.
/// @param threads that it may use.
/// @param known by earlier derivations, and for later ones; what it returns does not depend on it.  May be null.
/// @throws core::CoreError for a wrong parameter, or an artefact too large to be sent; kCancelled when
/// stopped.
Derived derive(const v1::Lease& lease, const PreparedJob& job, std::string_view stored,
               core::ExecutionContext* context = nullptr, unsigned threads = 1, KnownRidges* known = nullptr);

}  // namespace affskel::worker
