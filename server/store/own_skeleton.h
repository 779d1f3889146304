#pragma once

#include "store/rows.h"
#include "wire/artifact_kinds.h"

namespace affskel::server {

/// The artefact with which a job is done.
struct OwnSkeleton {
  const wire::ArtifactKindInfo& kind;
  wire::CanonicalParams params;
};

/// @throws StoreError kDamaged when the job's parameters cannot be read.
OwnSkeleton own_skeleton(const JobRow& job);

}  // namespace affskel::server
