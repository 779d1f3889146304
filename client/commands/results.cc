// Commands that write results: fetch, skeleton, surface, erode.
#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/follow.h"
#include "client/commands/shared/transfer.h"
#include "client/files/format.h"
#include "wire/params.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace affskel::client {
namespace {

// A sheet of chords comes with its quality, an alpha shape does not.
std::string advice_for_empty_surface(const Written& written) {
  if (!written.quality) {
    return "no three skeleton points are near enough; try a larger --alpha or a smaller --threshold";
  }
  const std::string& advice = written.quality->advice();
  return advice.empty() ? "no piece of the sheet is significant enough; try a smaller --threshold" : advice;
}

void finish(Context& context, const Written& written) {
  if (written.kind == "skeleton") {
    warn_if_empty(context.console(), written.items, written.quality.value_or(v1::SkeletonQuality()),
                  written.job);
  }
  if (written.kind == "surface" && written.items == 0) {
    context.console().warning("the surface is empty: " + advice_for_empty_surface(written));
  }
  if (written.kind == "eroded" && written.items == 0) {
    context.console().warning("the eroded solid is empty: " +
                              (written.advice.empty() ? "no sample point has such an E" : written.advice) +
                              "; try a lower level");
  }
  tell_written(context.console(), written);
  context.console().document(written_json(written));
}

// Formats that hold only points mean points; the others can hold a surface.
std::string eroded_form(const Destination& destination) {
  const std::string extension = destination.extension();
  for (const FileFormat format : surface_formats()) {
    if (extension == extension_of(format)) return "surface";
  }
  return "points";
}

// The mesh is what was submitted, whatever the file is called; surfaces of that name would be something else.
void warn_of_foreign_extension(Context& context, const Destination& destination) {
  const std::string extension = destination.extension();
  for (const FileFormat format : surface_formats()) {
    if (format == FileFormat::kOff || extension != extension_of(format)) continue;
    context.console().warning(destination.name() +
                              ": the mesh is written as it was submitted, as OFF text, not as '" + extension +
                              "'; affskel-client transform --scale 1 writes it in other formats");
  }
}

// The job that the command is about, and its skeleton's parameters when they are not the job's own.
struct Chosen {
  std::string job;
  std::optional<v1::SkeletonParams> params;
  const v1::SkeletonParams* get() const { return params ? &*params : nullptr; }
};

Chosen choose(Context& context, const JobOptions& options) {
  if (!options.skeleton.given()) return {options.job, {}};
  if (!options.skeleton.operator_name.empty()) return {options.job, skeleton_params(options.skeleton)};
  const v1::Job job = context.session().get_job(options.job);
  return {job.id(), skeleton_params(options.skeleton, job)};
}

}  // namespace

void run_fetch(Context& context, const JobOptions& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  if (options.artifact == "field") return finish(context, transfer_field(context, options.job, destination));
  if (options.artifact == "skeleton") {
    return finish(context, transfer_skeleton(context, options.job, nullptr, destination));
  }
  if (options.artifact == "surface") {
    return finish(context, transfer_surface(context, options.job, nullptr, destination));
  }
  if (options.artifact == "divergence") {
    const Chosen chosen = choose(context, options);
    return finish(context, transfer_divergence(context, chosen.job, chosen.get(), destination));
  }
  if (options.artifact == "eroded") return run_erode(context, options);
  warn_of_foreign_extension(context, destination);
  finish(context, transfer_mesh(context, options.job, destination));
}

void run_skeleton(Context& context, const JobOptions& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  const Chosen chosen = choose(context, options);
  finish(context, transfer_skeleton(context, chosen.job, chosen.get(), destination));
}

void run_surface(Context& context, const JobOptions& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  v1::SurfaceParams params;
  const Chosen chosen = choose(context, options);
  if (chosen.params) *params.mutable_skeleton() = *chosen.params;
  params.set_alpha(options.alpha);
  finish(context, transfer_surface(context, chosen.job, &params, destination));
}

void run_erode(Context& context, const JobOptions& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  v1::ErodedParams params;
  params.set_fraction(wire::kErodedFraction);
  if (options.fraction > 0) params.set_fraction(options.fraction);
  if (options.volume > 0) params.set_volume(options.volume);
  const std::string form = options.form.empty() ? eroded_form(destination) : options.form;
  finish(context, form == "points" ? transfer_eroded_points(context, options.job, params, destination)
                                   : transfer_eroded_surface(context, options.job, params, destination));
}

}  // namespace affskel::client
