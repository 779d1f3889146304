#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "affskel/v1/types.pb.h"
#include "client/commands/shared/context.h"

namespace affskel::client {

/// What the command line says of a skeleton.
struct SkeletonOptions {
  std::string operator_name;  ///< empty = the job's
  double threshold = 0;       ///< 0 = the operator's default
  bool given() const { return !operator_name.empty() || threshold > 0; }
};

/// --operator and --threshold.  Without a name of an operator in `skeleton` the default is the job's, or of
/// what is `shown` that of shown_skeleton().
void add_skeleton_options(CLI::App* command, SkeletonOptions& skeleton, bool shown = false);

/// The message for the operator's name. @throws ClientError kUsage for an unknown one.
v1::SkeletonParams skeleton_params(const SkeletonOptions& options);

/// What the options mean for a job with skeleton parameters of its own.  Without options these hold; a
/// threshold alone is for the job's operator; an operator alone takes its default threshold.  The result
/// names an operator.
v1::SkeletonParams skeleton_params(const SkeletonOptions& options, const v1::Job& job);

/// The same for surfaces, pictures and pages.  Without options a job with the published skeleton (Zucker and
/// Hummel's points above the published threshold) is shown by its ridge: a sheet without the gaps that the
/// points have, and steadier under noise (see the experiments' report).
v1::SkeletonParams shown_skeleton(const SkeletonOptions& options, const v1::Job& job);

/// The job that a command is about, and its skeleton's parameters when they are not the job's own.
struct ChosenSkeleton {
  std::string job;
  std::optional<v1::SkeletonParams> params;
  const v1::SkeletonParams* get() const { return params ? &*params : nullptr; }
};

/// Asks the server only where the meaning of the options depends on the job.
ChosenSkeleton choose_skeleton(Context& context, const std::string& job, const SkeletonOptions& options);

/// The same for surfaces: always with parameters.
ChosenSkeleton choose_shown_skeleton(Context& context, const std::string& job,
                                     const SkeletonOptions& options);

}  // namespace affskel::client
