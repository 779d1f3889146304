#include "store/own_skeleton.h"

#include "database/errors.h"

namespace affskel::server {

OwnSkeleton own_skeleton(const JobRow& job) {
  v1::SkeletonParams skeleton;
  if (!skeleton.ParseFromString(job.skeleton))
    throw StoreError(StoreError::Code::kDamaged, "job " + job.id + ": its skeleton's parameters are damaged");
  const wire::ArtifactKindInfo& kind = wire::own_skeleton_kind(skeleton.operator_());
  return {kind, wire::artifact_params(kind, {}, skeleton)};
}

}  // namespace affskel::server
