#include "client/commands/shared/skeleton_options.h"

#include <CLI/CLI.hpp>
#include <string>

#include "client/cli/value_checks.h"
#include "client/text/words.h"

namespace affskel::client {

void add_skeleton_options(CLI::App* command, SkeletonChoice& skeleton) {
  const bool of_job = skeleton.operator_name.empty();
  CLI::Option* name = command
                          ->add_option("--operator", skeleton.operator_name,
                                       std::string("How the skeleton is found") +
                                           (of_job ? " (default: the job's operator)" : ""))
                          ->check(one_of(operator_words()))
                          ->type_name("OP");
  if (!of_job) name->capture_default_str();
  command
      ->add_option(
          "--threshold", skeleton.threshold,
          std::string("Keep points with |H| above this, of chords what is more significant, of "
                      "ridge what is stronger, of curve limbs this many of their radii long (default: ") +
              (of_job ? "the operator's; without --operator the job's)" : "the operator's)"))
      ->check(positive_number())
      ->type_name("T");
}

}  // namespace affskel::client
