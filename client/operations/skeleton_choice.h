#pragma once

#include <string>

#include "affskel/v1/types.pb.h"
#include "client/connection/session.h"

namespace affskel::client {

/// What a request says of a skeleton.
struct SkeletonChoice {
  std::string operator_name;  ///< empty = the job's
  double threshold = 0;       ///< 0 = the operator's default
};

/// The message for the operator's name. @throws ClientError kUsage for an unknown one.
v1::SkeletonParams skeleton_params(const SkeletonChoice& choice);

/// What the choice means for a job with skeleton parameters of its own.  An empty one means these; a
/// threshold alone is for the job's operator; an operator alone takes its default threshold.  The result
/// names an operator.
v1::SkeletonParams skeleton_params(const SkeletonChoice& choice, const v1::Job& job);

/// The job that a request is about, and its skeleton's parameters.
struct ChosenSkeleton {
  std::string job;
  v1::SkeletonParams params;
};

/// Asks the server only where the meaning of the choice depends on the job.
ChosenSkeleton choose_skeleton(Session& session, const std::string& job, const SkeletonChoice& choice);

}  // namespace affskel::client
