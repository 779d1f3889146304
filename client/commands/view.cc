#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/fetch_view.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/skeleton_options.h"

namespace affskel::client {
namespace {

struct Options {
  std::string job, output;
  SkeletonOptions skeleton;  // not given: see shown_skeleton()
};

void run(Context& context, const Options& options) {
  const Destination destination = destination_of(options.output, "", context.console());
  choose_format(destination, page_formats(), "page");
  base::AtomicFile file(destination.file);
  const v1::Job job = finished_job(context, options.job);
  const ViewInput input = fetch_view(context, job, shown_skeleton(options.skeleton, job));
  const std::string page = view_page(input);
  file.write(page);
  file.commit();
  context.console().note("wrote " + destination.name() + " (page, " +
                         base::counted(input.points.size(), "point") + ", " + std::to_string(page.size()) +
                         " bytes): open it in a browser");
  context.console().document({{"job", job.id()},
                              {"artefact", "page"},
                              {"file", options.output},
                              {"points", input.points.size()},
                              {"bytes", page.size()}});
}

}  // namespace

void add_view(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      line.add("view",
               "Page for any browser: the body and its skeleton to turn, with sliders for the\n"
               "shock threshold and the erosion level; one file that needs no network",
               "  affskel-client view @last -o body.html\n"
               "  affskel-client view 3f2a9c --threshold 5 -o body.html",
               [options](Context& context) { run(context, *options); });
  add_job(command, options->job);
  add_skeleton_options(command, options->skeleton, true);
  add_output(command, options->output, "HTML file to write, or -");
}

}  // namespace affskel::client
