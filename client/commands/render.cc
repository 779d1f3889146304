#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/picture.h"
#include "client/commands/shared/skeleton_options.h"

namespace affskel::client {
namespace {

struct Options {
  std::string job, output;
  SkeletonOptions skeleton;  // not given: see shown_skeleton()
  int width = 1600;          // pixels
};

void run(Context& context, const Options& options) {
  const Destination destination = destination_of(options.output, "", context.console());
  choose_format(destination, picture_formats(), "picture");
  base::AtomicFile file(destination.file);
  const v1::Job job = finished_job(context, options.job);
  file.write(job_picture(context, job, options.skeleton, options.width));
  file.commit();
  context.console().note("wrote " + destination.name());
  context.console().document({{"job", job.id()}, {"artefact", "picture"}, {"file", options.output}});
}

}  // namespace

void add_render(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = line.add("render", "Picture of the body with its skeleton",
                               "  affskel-client render @last -o body.png --width 2400\n"
                               "  affskel-client render @last --operator zucker-hummel -o points.png\n"
                               "A skeleton by ridge or chords is drawn as its sheet, any other as its points",
                               [options](Context& context) { run(context, *options); });
  add_job(command, options->job);
  add_skeleton_options(command, options->skeleton, true);
  command->add_option("--width", options->width, "Pixels")
      ->check(whole_number(200, 8000))
      ->capture_default_str()
      ->type_name("W");
  add_output(command, options->output, "PNG file to write, or -");
}

}  // namespace affskel::client
