#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/notices.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/stance_option.h"
#include "client/operations/job_notices.h"
#include "client/operations/picture.h"

namespace affskel::client {
namespace {

struct RenderCommandOptions {
  std::string job, output;
  PictureOptions picture;
  std::string up, background = "white", colour = "E";
  std::vector<std::string> cameras;  // empty: the usual ones
  bool no_mesh = false;
};

PictureOptions picture_of(const RenderCommandOptions& options) {
  PictureOptions picture = options.picture;
  picture.stance = chosen_stance(options.up);
  picture.colour = options.colour == "part"        ? PictureColour::kPart
                   : options.colour == "thickness" ? PictureColour::kThickness
                                                   : PictureColour::kErosion;
  picture.render.background = parse_background(options.background);
  picture.render.mesh = !options.no_mesh;
  if (!options.cameras.empty()) picture.render.cameras.clear();
  for (const std::string& camera : options.cameras) picture.render.cameras.push_back(parse_camera(camera));
  return picture;
}

void run_render(Context& context, const RenderCommandOptions& options) {
  const PictureOptions wanted = picture_of(options);
  const Destination destination = destination_of(options.output, "", context.console());
  choose_format(destination, picture_formats(), "picture");
  base::AtomicFile file(destination.file);
  const v1::Job job = finished_job(context.session(), options.job);
  const Picture picture = make_picture(context.session(), job, wanted);
  file.write(picture.png);
  file.commit();
  say(context.console(), picture.notices);
  context.console().note("wrote " + destination.name());
  context.console().document(
      {{"job", job.id()}, {"artefact", "picture"}, {"file", options.output}, {"shown", picture.shown}});
}

void add_looks(CLI::App* command, RenderCommandOptions& options) {
  add_stance(command, options.up);
  command
      ->add_option("--camera", options.cameras,
                   camera_words() +
                       ", or azimuth and elevation\nin degrees: 0,0 is the front, 90,0 the side, "
                       "0,90 the top; given again, up to\n6 times, for more views (default: front, "
                       "side, top). Orthographic, the whole\nbody in each, all at one scale")
      ->allow_extra_args(false)
      ->type_name("VIEW");
  command
      ->add_option("--level", options.picture.level,
                   "Draw the eroded solid at this share of v0, too: 0.05 or 5%")
      ->transform(proper_share())
      ->type_name("F");
  command
      ->add_option("--colour", options.colour,
                   "What colours tell: E on the skeleton, the body's part (see measure) or its\n"
                   "thickness (see fetch), each by the job's own skeleton: these two without\n"
                   "--operator, --threshold and --no-mesh")
      ->check(one_of({"E", "part", "thickness"}))
      ->capture_default_str()
      ->type_name("WHAT");
  command->add_flag("--no-mesh", options.no_mesh, "Leave out the body's surface");
  command->add_option("--background", options.background, "white, black, dark, #RGB or #RRGGBB")
      ->capture_default_str()
      ->type_name("COLOUR");
  command->add_option("--width", options.picture.render.width, "Pixels; the height follows from the shape")
      ->check(whole_number(200, 8000))
      ->capture_default_str()
      ->type_name("W");
}

void check_options(const CLI::App& render) {
  if (render.get_option("--colour")->as<std::string>() == "E") return;
  for (const char* name : {"--operator", "--threshold", "--no-mesh"})
    if (render.count(name) > 0)
      throw CLI::ValidationError("--colour", std::string("paints the body and does not go with ") + name);
}

}  // namespace

void add_render(CommandLine& line) {
  const auto options = std::make_shared<RenderCommandOptions>();
  CLI::App* command = line.add(
      "render", "Picture of the body with its skeleton",
      "  affskel-client render @last -o body.png --width 2400\n"
      "  affskel-client render @last --camera 30,20 --level 5% -o eroded.png\n"
      "  affskel-client render @last --operator zucker-hummel -o points.png\n"
      "  affskel-client render @last --colour part -o parts.png\n"
      "A skeleton by ridge or chords is drawn as its sheet, by curve\n"
      "as its lines, any other as its points",
      [options](Context& context) { run_render(context, *options); }, check_options);
  add_job(command, options->job);
  add_skeleton_options(command, options->picture.skeleton);
  add_looks(command, *options);
  add_output(command, options->output, "PNG file to write, or -");
}

}  // namespace affskel::client
