#include <CLI/CLI.hpp>
#include <memory>

#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/transfer.h"

namespace affskel::client {
namespace {

struct Options {
  std::string job, output, format;
  SkeletonOptions skeleton;  // no operator: the job's
  double alpha = 0;          // squared radius, 0 = from the spacing
};

void run(Context& context, const Options& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  v1::SurfaceParams params;
  const ChosenSkeleton chosen = choose_skeleton(context, options.job, options.skeleton);
  if (chosen.params) *params.mutable_skeleton() = *chosen.params;
  params.set_alpha(options.alpha);
  tell_result(context.console(), transfer_surface(context, chosen.job, &params, destination));
}

}  // namespace

void add_surface(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = line.add(
      "surface", "Triangulated skeleton: the alpha shape of its points, or the sheet of chords, ridge",
      "  affskel-client surface @last -o skeleton.stl\n"
      "  affskel-client surface @last --threshold 5 --alpha 160000 -o skeleton.obj",
      [options](Context& context) { run(context, *options); });
  add_job(command, options->job);
  add_skeleton_options(command, options->skeleton);
  command->add_option("--alpha", options->alpha, "Squared radius in mesh units squared (default: 3 DT^2)")
      ->check(positive_number())
      ->type_name("A");
  add_output(command, options->output, "File to write: .off .ply .obj .stl .vtp, or -");
  add_format(command, options->format);
}

}  // namespace affskel::client
