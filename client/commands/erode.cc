#include <CLI/CLI.hpp>
#include <memory>

#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/written.h"

namespace affskel::client {
namespace {

struct ErodeOptions {
  std::string job, output, format;
  double fraction = 0;  // level as a share of v0, 0 = not given
  double volume = 0;    // level, mesh units cubed, 0 = not given
  std::string form;     // "points" or "surface", empty = by the extension
};

void run_erode(Context& context, const ErodeOptions& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  FetchRequest request{options.job, "eroded", destination};
  if (options.fraction > 0) request.eroded.set_fraction(options.fraction);
  if (options.volume > 0) request.eroded.set_volume(options.volume);
  if (options.form == "points") request.form = FetchRequest::Form::kPoints;
  if (options.form == "surface") request.form = FetchRequest::Form::kSurface;
  show_result(context.console(), fetch(context.session(), request));
}

}  // namespace

void add_erode(CommandLine& line) {
  const auto options = std::make_shared<ErodeOptions>();
  CLI::App* command = line.add(
      "erode", "Eroded solid: where E is at least a level, from the stored field",
      "  affskel-client erode @last --fraction 5% -o eroded.stl\n"
      "  affskel-client erode @last --volume 2e9 --as points -o eroded.ply\n"
      "The volume that is left is told: of a surface what it encloses, of points their\n"
      "share of the sample points times v0",
      [options](Context& context) { run_erode(context, *options); },
      [](const CLI::App& erode) {
        if (erode.count("--fraction") + erode.count("--volume") == 0) {
          throw CLI::RequiredError("--fraction or --volume");
        }
      });
  add_job(command, options->job);
  CLI::Option* fraction =
      command->add_option("--fraction", options->fraction, "Level as a share of v0: 0.1 or 10%")
          ->transform(proper_share())
          ->type_name("F");
  command->add_option("--volume", options->volume, "Level in mesh units cubed, below v0")
      ->check(positive_number())
      ->type_name("V")
      ->excludes(fraction);
  command->add_option("--as", options->form, "points or surface (default: what the extension can hold)")
      ->check(one_of({"points", "surface"}))
      ->type_name("FORM");
  add_output(command, options->output,
             "Points: .csv .ply .off .xyz .vtp; surface: .off .ply .obj .stl .vtp; - is stdout");
  add_format(command, options->format);
}

}  // namespace affskel::client
