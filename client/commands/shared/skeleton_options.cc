#include "client/commands/shared/skeleton_options.h"

#include <CLI/CLI.hpp>

#include "base/published_threshold.h"
#include "client/cli/value_checks.h"
#include "client/text/words.h"

namespace affskel::client {

void add_skeleton_options(CLI::App* command, SkeletonOptions& skeleton, bool shown) {
  const bool of_job = skeleton.operator_name.empty();
  const char* preset = shown    ? " (default: ridge; the job's, if that is not the default one)"
                       : of_job ? " (default: the job's operator)"
                                : "";
  CLI::Option* name =
      command->add_option("--operator", skeleton.operator_name, std::string("How shocks are found") + preset)
          ->check(one_of(operator_words()))
          ->type_name("OP");
  if (!of_job) name->capture_default_str();
  command
      ->add_option("--threshold", skeleton.threshold,
                   std::string("Keep points with |H| above this, of chords what is more significant, of "
                               "ridge what is stronger (default: ") +
                       (of_job ? "the operator's; without --operator the job's)" : "the operator's)"))
      ->check(positive_number())
      ->type_name("T");
}

v1::SkeletonParams skeleton_params(const SkeletonOptions& options) {
  v1::SkeletonParams params;
  params.set_operator_(operator_named(options.operator_name));
  params.set_threshold(options.threshold);
  return params;
}

v1::SkeletonParams skeleton_params(const SkeletonOptions& options, const v1::Job& job) {
  v1::SkeletonParams params = options.operator_name.empty() ? job.skeleton() : skeleton_params(options);
  if (options.threshold > 0) params.set_threshold(options.threshold);
  if (params.operator_() == v1::OPERATOR_UNSPECIFIED) params.set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  return params;
}

v1::SkeletonParams shown_skeleton(const SkeletonOptions& options, const v1::Job& job) {
  v1::SkeletonParams params = skeleton_params(options, job);
  const bool published = params.operator_() == v1::OPERATOR_ZUCKER_HUMMEL &&
                         (params.threshold() == 0 || params.threshold() == base::kZuckerHummelThreshold);
  if (options.given() || !published) return params;
  v1::SkeletonParams ridge;
  ridge.set_operator_(v1::OPERATOR_RIDGE);
  return ridge;
}

ChosenSkeleton choose_skeleton(Context& context, const std::string& job, const SkeletonOptions& options) {
  if (!options.given()) return {job, {}};
  if (!options.operator_name.empty()) return {job, skeleton_params(options)};
  const v1::Job known = context.session().get_job(job);
  return {known.id(), skeleton_params(options, known)};
}

ChosenSkeleton choose_shown_skeleton(Context& context, const std::string& job,
                                     const SkeletonOptions& options) {
  if (!options.operator_name.empty()) return {job, skeleton_params(options)};
  const v1::Job known = context.session().get_job(job);
  return {known.id(), shown_skeleton(options, known)};
}

}  // namespace affskel::client
