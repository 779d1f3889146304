#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/written.h"

namespace affskel::client {
namespace {

struct SkeletonOptions {
  std::string job, output, format;
  SkeletonChoice skeleton;  // no operator: the job's
};

void run_skeleton(Context& context, const SkeletonOptions& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  const FetchRequest request{options.job, "skeleton", destination, options.skeleton};
  show_result(context.console(), fetch(context.session(), request));
}

}  // namespace

void add_skeleton(CommandLine& line) {
  const auto options = std::make_shared<SkeletonOptions>();
  CLI::App* command = line.add("skeleton", "Skeleton with other parameters, from the stored field",
                               "  affskel-client skeleton @last --threshold 5 -o fine.ply",
                               [options](Context& context) { run_skeleton(context, *options); });
  add_job(command, options->job);
  add_skeleton_options(command, options->skeleton);
  add_output(command, options->output, "File to write: .csv .ply .off .xyz .vtp, or -");
  add_format(command, options->format);
}

}  // namespace affskel::client
