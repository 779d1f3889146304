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

struct SkeletonOptions {
  FetchRequest request;  // no operator: the job's
  std::string output, format, form;
};

void run_skeleton(Context& context, const SkeletonOptions& options) {
  FetchRequest request = options.request;
  request.destination = destination_of(options.output, options.format, context.console());
  if (options.form == "points") request.form = FetchRequest::Form::kPoints;
  if (options.form == "complex") request.form = FetchRequest::Form::kSurface;
  show_result(context.console(), fetch(context.session(), request));
}

void add_complex_options(CLI::App* command, FetchRequest& request) {
  command
      ->add_option("--alpha", request.alpha,
                   "Of points, their alpha shape: squared radius in mesh units squared\n(default: 3 DT^2)")
      ->check(positive_number())
      ->type_name("A");
  command->add_flag("--barrier", request.barrier,
                    "Of a sheet, at its vertices: by what share of E the chord grows on the way from one "
                    "side's direction to the other's; 0: the normals only turn fast, large: they jump");
  command
      ->add_option("--min-barrier", request.min_barrier,
                   "Drop the sheet's triangles with a vertex of a lower barrier; implies --barrier")
      ->check(positive_number())
      ->type_name("B");
}

// Points have neither.
void check_options(const CLI::App& skeleton) {
  if (skeleton.get_option("--as")->as<std::string>() != "points") return;
  for (const char* name : {"--alpha", "--barrier", "--min-barrier"})
    if (skeleton.count(name) > 0) throw CLI::ValidationError(name, "is for triangles, not for --as points");
}

}  // namespace

void add_skeleton(CommandLine& line) {
  const auto options = std::make_shared<SkeletonOptions>();
  options->request.artifact = "skeleton";
  CLI::App* command = line.add(
      "skeleton", "Skeleton with other parameters, from the stored field",
      "  affskel-client skeleton @last --threshold 8 -o strong.vtp\n"
      "  affskel-client skeleton @last --operator curve -o limbs.vtp\n"
      "  affskel-client skeleton @last --barrier -o sheet.vtp\n"
      "  affskel-client skeleton @last --operator zucker-hummel -o points.csv\n"
      "  affskel-client skeleton @last --operator sobel --as complex -o shape.ply\n"
      ".vtp, .ply and .obj hold sheets with their curves, .off and .stl sheets alone,\n"
      ".csv and .xyz the vertices, of chords the shocks on lattice edges, .csv with the\n"
      "optimal normal nx ny nz at a sample point beside them; .swc .json .graphml .glb\n"
      "are for --operator curve.\n"
      "The published operators (zucker-hummel, sobel, central, intermediate, flux)\n"
      "give points, or as complex their alpha shape",
      [options](Context& context) { run_skeleton(context, *options); }, check_options);
  add_job(command, options->request.job);
  add_skeleton_options(command, options->request.skeleton);
  command
      ->add_option("--as", options->form,
                   "complex or points (default: what the operator gives and the extension can\nhold)")
      ->check(one_of({"complex", "points"}))
      ->type_name("FORM");
  add_complex_options(command, options->request);
  add_output(command, options->output, "File to write: .vtp .ply .obj .stl .off .csv .xyz, or -");
  add_format(command, options->format);
}

void add_surface(CommandLine& line) {
  const auto options = std::make_shared<SkeletonOptions>();
  options->request.artifact = "surface";
  CLI::App* command =
      line.add("surface", "The same as skeleton --as complex",
               "  affskel-client surface @last -o sheet.vtp\n"
               "  affskel-client surface @last --operator chords --min-barrier 0.05 -o shocks.ply",
               [options](Context& context) { run_skeleton(context, *options); });
  add_job(command, options->request.job);
  add_skeleton_options(command, options->request.skeleton);
  add_complex_options(command, options->request);
  add_output(command, options->output, "File to write: .vtp .ply .obj .stl .off, or -");
  add_format(command, options->format);
}

}  // namespace affskel::client
