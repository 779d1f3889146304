// The picture of a job: fetches what it needs, hands it to client/render.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "client/artifacts/skeleton_points.h"
#include "client/cli/value_checks.h"
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/fetch_artifact.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/render/scene.h"
#include "client/text/skeleton_text.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

struct Options {
  std::string job, output;
  SkeletonOptions skeleton;  // no operator: the job's
  int width = 1600;          // pixels
};

// The steps of the lattice, mesh units; a job of a server that told no frame has cubic cells.
std::array<core::Vec3, 3> lattice_cell(const v1::PreparedSummary& prepared) {
  std::array<core::Vec3, 3> cell = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int a = 0; a < 3; ++a) {
    core::Vec3& axis = cell[static_cast<std::size_t>(a)];
    if (prepared.frame_size() == 9)
      axis = {prepared.frame(3 * a), prepared.frame(3 * a + 1), prepared.frame(3 * a + 2)};
    axis = prepared.spacing() * axis;
  }
  return cell;
}

std::string title_of(const RenderInput& input, const v1::Job& job, const v1::SkeletonParams& params) {
  const std::string skeleton = wire::gives_sheet(params.operator_())
                                   ? "sheet of " + base::counted(input.sheet.corners_size() / 3, "triangle")
                                   : base::counted(input.skeleton.point_size(), "skeleton point");
  return job.name() + ": " + std::to_string(input.mesh.triangles.size()) + " triangles, " +
         base::counted(job.prepared().points(), "sample point") + " at spacing " +
         base::rounded(job.prepared().spacing(), 4) + ", " + skeleton + " (" + skeleton_params_text(params) +
         ")";
}

// @param own whether the parameters are the job's, whose skeleton is stored.
v1::SkeletonPoints fetch_points(Context& context, const v1::Job& job, const v1::SkeletonParams& params,
                                bool own) {
  v1::FetchArtifactRequest request = request_for(job.id(), v1::ARTIFACT_KIND_SKELETON);
  if (!own) *request.mutable_skeleton() = params;
  v1::ArtifactHeader header;
  return parse_skeleton(fetch_patiently(context, request, header, "skeleton"));
}

// The skeleton as its operator gives it: points, or its sheet.  Tells when there is none.
// Returns the threshold that was applied, 0 when the server does not say.
double fetch_skeleton(Context& context, const v1::Job& job, const v1::SkeletonParams& params, bool own,
                      RenderInput& input) {
  const bool sheet = wire::gives_sheet(params.operator_());
  if (sheet) {
    input.sheet = fetch_sheet(context, job.id(), params);
  } else {
    input.skeleton = fetch_points(context, job, params, own);
  }
  const v1::SkeletonQuality& quality = sheet ? input.sheet.quality() : input.skeleton.quality();
  const int items = sheet ? input.sheet.corners_size() / 3 : input.skeleton.point_size();
  warn_about_skeleton(context.console(), static_cast<std::uint64_t>(items), quality, job);
  return quality.threshold();
}

void run(Context& context, const Options& options) {
  const Destination destination = destination_of(options.output, "", context.console());
  choose_format(destination, picture_formats(), "picture");
  base::AtomicFile file(destination.file);
  const v1::Job job = finished_job(context, options.job);
  v1::SkeletonParams params = skeleton_params(options.skeleton, job);
  RenderInput input;
  const double applied = fetch_skeleton(context, job, params, !options.skeleton.given(), input);
  if (params.threshold() == 0) params.set_threshold(applied);  // the default, for the title
  input.mesh = fetch_mesh(context, job.id());
  input.cell = lattice_cell(job.prepared());
  input.volume = job.prepared().volume();
  input.title = title_of(input, job, params);
  file.write(encode_png(render_scene(input, {options.width})));
  file.commit();
  context.console().note("wrote " + destination.name());
  context.console().document({{"job", job.id()}, {"artefact", "picture"}, {"file", options.output}});
}

}  // namespace

void add_render(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = line.add("render", "Picture of the body with its skeleton",
                               "  affskel-client render @last -o body.png --width 2400\n"
                               "  affskel-client render @last --operator chords -o sheet.png\n"
                               "A skeleton by chords or ridge is drawn as its sheet, any other as its points",
                               [options](Context& context) { run(context, *options); });
  add_job(command, options->job);
  add_skeleton_options(command, options->skeleton);
  command->add_option("--width", options->width, "Pixels")
      ->check(whole_number(200, 8000))
      ->capture_default_str()
      ->type_name("W");
  add_output(command, options->output, "PNG file to write, or -");
}

}  // namespace affskel::client
