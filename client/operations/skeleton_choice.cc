#include "client/operations/skeleton_choice.h"

#include "client/text/words.h"
#include "wire/params.h"

namespace affskel::client {

v1::SkeletonParams skeleton_params(const SkeletonChoice& choice) {
  v1::SkeletonParams params;
  params.set_operator_(operator_named(choice.operator_name));
  params.set_threshold(choice.threshold);
  return params;
}

v1::SkeletonParams skeleton_params(const SkeletonChoice& choice, const v1::Job& job) {
  v1::SkeletonParams params = choice.operator_name.empty() ? job.skeleton() : skeleton_params(choice);
  if (choice.threshold != 0) params.set_threshold(choice.threshold);
  if (params.operator_() == v1::OPERATOR_UNSPECIFIED) params.set_operator_(wire::kDefaultOperator);
  return params;
}

ChosenSkeleton choose_skeleton(Session& session, const std::string& job, const SkeletonChoice& choice) {
  if (!choice.operator_name.empty()) return {job, skeleton_params(choice)};
  const v1::Job known = session.get_job(job);
  return {known.id(), skeleton_params(choice, known)};
}

}  // namespace affskel::client
