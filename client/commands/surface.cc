#include <CLI/CLI.hpp>
#include <memory>

#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/transfer.h"
#include "client/text/words.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

struct Options {
  std::string job, output, format;
  SkeletonOptions skeleton;  // not given: see shown_skeleton()
  double alpha = 0;          // squared radius, 0 = from the spacing
  bool barrier = false;
  double min_barrier = 0;
};

// The barrier is one of sheets.  --alpha and --threshold are for the job's own skeleton, which may be points.
void require_sheet(Context& context, const Options& options, const ChosenSkeleton& chosen) {
  if (!options.barrier && options.min_barrier == 0) return;
  if (!options.skeleton.operator_name.empty()) return;  // the server names what does not go with it
  const v1::Operator which = chosen.params ? chosen.params->operator_()
                                           : context.session().get_job(chosen.job).skeleton().operator_();
  if (wire::gives_sheet(which)) return;
  const std::string points = "the job's own skeleton, the points of " + operator_word(which);
  const std::string without =
      options.alpha > 0 ? "--alpha without --operator is for " + points + "; leave it out for the ridge"
      : options.skeleton.threshold > 0 ? "--threshold without --operator is for " + points +
                                             "; add --operator ridge, whose threshold is 5 radians"
                                       : "without --operator this is " + points + "; add --operator ridge";
  throw ClientError(ExitCode::kUsage, "barriers are for the sheets of ridge and chords, and " + without);
}

void run(Context& context, const Options& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  v1::SurfaceParams params;
  // An alpha shape is one of points.
  const ChosenSkeleton chosen = options.alpha > 0
                                    ? choose_skeleton(context, options.job, options.skeleton)
                                    : choose_shown_skeleton(context, options.job, options.skeleton);
  require_sheet(context, options, chosen);
  if (chosen.params) *params.mutable_skeleton() = *chosen.params;
  params.set_alpha(options.alpha);
  params.set_barrier(options.barrier || options.min_barrier > 0);
  params.set_min_barrier(options.min_barrier);
  tell_result(context, transfer_surface(context, chosen.job, params, destination));
}

}  // namespace

void add_surface(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      line.add("surface", "Triangulated skeleton: the sheet of ridge or chords, or the alpha shape of points",
               "  affskel-client surface @last -o sheet.vtp\n"
               "  affskel-client surface @last --barrier -o sheet.vtp\n"
               "  affskel-client surface @last --operator chords --min-barrier 0.05 -o shocks.ply\n"
               "  affskel-client surface @last --operator zucker-hummel --alpha 160000 -o skeleton.obj\n"
               ".vtp, .ply and .obj also hold the curves of ridge",
               [options](Context& context) { run(context, *options); });
  add_job(command, options->job);
  add_skeleton_options(command, options->skeleton, true);
  command
      ->add_option("--alpha", options->alpha,
                   "Of an alpha shape: squared radius in mesh units squared (default: 3 DT^2);\nwithout "
                   "--operator of the job's points")
      ->check(positive_number())
      ->type_name("A");
  command->add_flag("--barrier", options->barrier,
                    "Of a sheet, at its vertices: by what share of E the chord grows on the way from one "
                    "side's direction to the other's; 0: the normals only turn fast, large: they jump");
  command
      ->add_option("--min-barrier", options->min_barrier,
                   "Drop the sheet's triangles with a vertex of a lower barrier; implies --barrier")
      ->check(positive_number())
      ->type_name("B");
  add_output(command, options->output, "File to write: .off .ply .obj .stl .vtp, or -");
  add_format(command, options->format);
}

}  // namespace affskel::client
