// Commands that write results: fetch, skeleton, surface, erode, render.
#include "client/commands/commands.h"
#include "client/commands/follow.h"
#include "client/commands/transfer.h"
#include "client/exporters/atomic_file.h"
#include "client/exporters/format.h"
#include "client/exporters/numbers.h"
#include "client/exporters/skeleton_writer.h"
#include "client/input_file.h"
#include "client/render/scene.h"
#include "wire/params.h"

#include <nlohmann/json.hpp>

namespace affskel::client {
namespace {

void finish(Context& context, const Written& written) {
  if (written.kind == "skeleton")
    warn_if_empty(context.console(), written.items, written.quality, written.job);
  if (written.kind == "surface" && written.items == 0) {
    context.console().warning(
        "the surface is empty: no three skeleton points are near enough; try a larger --alpha or a smaller "
        "--threshold");
  }
  if (written.kind == "eroded" && written.items == 0) {
    context.console().warning("the eroded solid is empty: no sample point has such an E; try a lower level");
  }
  tell_written(context.console(), written);
  context.console().document(written_json(written));
}

// Formats that hold only points mean points; the others can hold a surface.
std::string eroded_form(const std::filesystem::path& file) {
  for (const FileFormat format : surface_formats()) {
    if (file.extension() == extension_of(format)) return "surface";
  }
  return "points";
}

std::string title_of(const v1::Job& job, const core::Mesh& mesh, int skeleton_points) {
  return job.name() + ": " + std::to_string(mesh.triangles.size()) + " triangles, " +
         std::to_string(job.prepared().points()) + " sample points at spacing " +
         rounded(job.prepared().spacing(), 4) + ", " + std::to_string(skeleton_points) + " skeleton points";
}

}  // namespace

void run_fetch(Context& context, const JobOptions& options) {
  if (options.artifact == "field")
    return finish(context, transfer_field(context, options.job, options.output));
  if (options.artifact == "skeleton") {
    return finish(context, transfer_skeleton(context, options.job, nullptr, options.output));
  }
  if (options.artifact == "surface") {
    return finish(context, transfer_surface(context, options.job, nullptr, options.output));
  }
  if (options.artifact == "divergence") {
    const v1::SkeletonParams params = skeleton_params(options.skeleton);
    return finish(context, transfer_divergence(context, options.job, options.own_skeleton ? nullptr : &params,
                                               options.output));
  }
  if (options.artifact == "eroded") return run_erode(context, options);
  finish(context, transfer_mesh(context, options.job, options.output));
}

void run_skeleton(Context& context, const JobOptions& options) {
  const v1::SkeletonParams params = skeleton_params(options.skeleton);
  const bool own = options.own_skeleton;
  finish(context, transfer_skeleton(context, options.job, own ? nullptr : &params, options.output));
}

void run_surface(Context& context, const JobOptions& options) {
  v1::SurfaceParams params;
  if (!options.own_skeleton) *params.mutable_skeleton() = skeleton_params(options.skeleton);
  params.set_alpha(options.alpha);
  finish(context, transfer_surface(context, options.job, &params, options.output));
}

void run_erode(Context& context, const JobOptions& options) {
  v1::ErodedParams params;
  params.set_fraction(wire::kErodedFraction);
  if (options.fraction > 0) params.set_fraction(options.fraction);
  if (options.volume > 0) params.set_volume(options.volume);
  const std::string form = options.form.empty() ? eroded_form(options.output) : options.form;
  finish(context, form == "points" ? transfer_eroded_points(context, options.job, params, options.output)
                                   : transfer_eroded_surface(context, options.job, params, options.output));
}

void run_render(Context& context, const JobOptions& options) {
  choose_format(options.output, picture_formats(), "picture");
  v1::FetchArtifactRequest request;
  request.set_job(options.job);
  request.set_kind(v1::ARTIFACT_KIND_SKELETON);
  v1::ArtifactHeader header;
  RenderInput input;
  input.skeleton = parse_skeleton(fetch_patiently(context, request, header, "skeleton"));
  request.set_job(header.job().id());
  request.set_kind(v1::ARTIFACT_KIND_MESH);
  input.mesh = parse_mesh(context.session().fetch_bytes(request), "mesh of job " + header.job().id()).mesh;
  input.spacing = header.job().prepared().spacing();
  input.volume = header.job().prepared().volume();
  input.title = title_of(header.job(), input.mesh, input.skeleton.point_size());
  warn_if_empty(context.console(), static_cast<std::uint64_t>(input.skeleton.point_size()),
                input.skeleton.quality(), header.job());
  AtomicFile file(options.output);
  file.write(encode_png(render_scene(input, {options.width})));
  file.commit();
  context.console().note("wrote " + options.output);
  context.console().document({{"job", header.job().id()}, {"artefact", "picture"}, {"file", options.output}});
}

}  // namespace affskel::client
