#include "client/operations/skeleton_choice.h"

#include "base/published_threshold.h"
#include "client/text/words.h"

namespace affskel::client {

v1::SkeletonParams skeleton_params(const SkeletonChoice& choice) {
  v1::SkeletonParams params;
  params.set_operator_(operator_named(choice.operator_name));
  params.set_threshold(choice.threshold);
  return params;
}

v1::SkeletonParams skeleton_params(const SkeletonChoice& choice, const v1::Job& job) {
  v1::SkeletonParams params = choice.operator_name.empty() ? job.skeleton() : skeleton_params(choice);
  if (choice.threshold > 0) params.set_threshold(choice.threshold);
  if (params.operator_() == v1::OPERATOR_UNSPECIFIED) params.set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  return params;
}

v1::SkeletonParams shown_skeleton(const SkeletonChoice& choice, const v1::Job& job) {
  v1::SkeletonParams params = skeleton_params(choice, job);
  const bool published = params.operator_() == v1::OPERATOR_ZUCKER_HUMMEL &&
                         (params.threshold() == 0 || params.threshold() == base::kZuckerHummelThreshold);
  if (choice.given() || !published) return params;
  v1::SkeletonParams ridge;
  ridge.set_operator_(v1::OPERATOR_RIDGE);
  return ridge;
}

ChosenSkeleton choose_skeleton(Session& session, const std::string& job, const SkeletonChoice& choice) {
  if (!choice.given()) return {job, {}};
  if (!choice.operator_name.empty()) return {job, skeleton_params(choice)};
  const v1::Job known = session.get_job(job);
  return {known.id(), skeleton_params(choice, known)};
}

ChosenSkeleton choose_shown_skeleton(Session& session, const std::string& job, const SkeletonChoice& choice) {
  if (!choice.operator_name.empty()) return {job, skeleton_params(choice)};
  const v1::Job known = session.get_job(job);
  return {known.id(), shown_skeleton(choice, known)};
}

}  // namespace affskel::client
