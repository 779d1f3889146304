#include <CLI/CLI.hpp>
#include <memory>

#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/written.h"

namespace affskel::client {
namespace {

struct SurfaceOptions {
  FetchRequest request;  // skeleton not given: see shown_skeleton()
  std::string output, format;
};

void run_surface(Context& context, const SurfaceOptions& options) {
  FetchRequest request = options.request;
  request.artifact = "surface";
  request.destination = destination_of(options.output, options.format, context.console());
  show_result(context.console(), fetch(context.session(), request));
}

}  // namespace

void add_surface(CommandLine& line) {
  const auto options = std::make_shared<SurfaceOptions>();
  CLI::App* command =
      line.add("surface", "Triangulated skeleton: the sheet of ridge or chords, or the alpha shape of points",
               "  affskel-client surface @last -o sheet.vtp\n"
               "  affskel-client surface @last --barrier -o sheet.vtp\n"
               "  affskel-client surface @last --operator curve -o limbs.vtp\n"
               "  affskel-client surface @last --operator chords --min-barrier 0.05 -o shocks.ply\n"
               "  affskel-client surface @last --operator zucker-hummel --alpha 160000 -o skeleton.obj\n"
               ".vtp, .ply and .obj also hold the curves of ridge",
               [options](Context& context) { run_surface(context, *options); });
  add_job(command, options->request.job);
  add_skeleton_options(command, options->request.skeleton, true);
  command
      ->add_option("--alpha", options->request.alpha,
                   "Of an alpha shape: squared radius in mesh units squared (default: 3 DT^2);\nwithout "
                   "--operator of the job's points")
      ->check(positive_number())
      ->type_name("A");
  command->add_flag("--barrier", options->request.barrier,
                    "Of a sheet, at its vertices: by what share of E the chord grows on the way from one "
                    "side's direction to the other's; 0: the normals only turn fast, large: they jump");
  command
      ->add_option("--min-barrier", options->request.min_barrier,
                   "Drop the sheet's triangles with a vertex of a lower barrier; implies --barrier")
      ->check(positive_number())
      ->type_name("B");
  add_output(command, options->output, "File to write: .off .ply .obj .stl .vtp, or -");
  add_format(command, options->format);
}

}  // namespace affskel::client
