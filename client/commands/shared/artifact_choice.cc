#include "client/commands/shared/artifact_choice.h"

#include <algorithm>
#include <array>

#include "client/commands/shared/transfer.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

Written fetch_divergence(Context& context, const ArtifactChoice& choice, const Destination& destination) {
  const ChosenSkeleton chosen = choose_skeleton(context, choice.job, choice.skeleton);
  return transfer_divergence(context, chosen.job, chosen.get(), destination);
}

Written fetch_skeleton(Context& context, const ArtifactChoice& choice, const Destination& destination) {
  const ChosenSkeleton chosen = choose_skeleton(context, choice.job, choice.skeleton);
  return transfer_skeleton(context, chosen.job, chosen.get(), destination);
}

Written fetch_surface(Context& context, const ArtifactChoice& choice, const Destination& destination) {
  const ChosenSkeleton chosen = choose_shown_skeleton(context, choice.job, choice.skeleton);
  v1::SurfaceParams params;
  *params.mutable_skeleton() = *chosen.params;
  return transfer_surface(context, chosen.job, params, destination);
}

Written fetch_eroded(Context& context, const ArtifactChoice& choice, const Destination& destination) {
  v1::ErodedParams params = choice.eroded;
  if (params.level_case() == v1::ErodedParams::LEVEL_NOT_SET) params.set_fraction(wire::kErodedFraction);
  return holds_eroded_surface(destination) ? transfer_eroded_surface(context, choice.job, params, destination)
                                           : transfer_eroded_points(context, choice.job, params, destination);
}

Written fetch_submitted_mesh(Context& context, const ArtifactChoice& choice, const Destination& destination) {
  return transfer_mesh(context, choice.job, destination);
}

Written fetch_field(Context& context, const ArtifactChoice& choice, const Destination& destination) {
  return transfer_field(context, choice.job, destination);
}

std::span<const FileFormat> no_other() {
  return {};
}

// What can be fetched, in the order of the help.
struct Artifact {
  const char* name;
  std::span<const FileFormat> (*formats)();
  std::span<const FileFormat> (*more_formats)();  // of another form of it
  Written (*fetch)(Context& context, const ArtifactChoice& choice, const Destination& destination);
};

constexpr std::array<Artifact, 6> kArtifacts = {{
    {"field", field_formats, no_other, fetch_field},
    {"divergence", divergence_formats, no_other, fetch_divergence},
    {"skeleton", skeleton_formats, no_other, fetch_skeleton},
    {"surface", surface_formats, no_other, fetch_surface},
    {"eroded", surface_formats, skeleton_formats, fetch_eroded},
    {"mesh", surface_formats, no_other, fetch_submitted_mesh},
}};

const Artifact& artifact_named(const std::string& name) {
  const auto chosen = std::find_if(kArtifacts.begin(), kArtifacts.end(),
                                   [&](const Artifact& artifact) { return name == artifact.name; });
  if (chosen != kArtifacts.end()) return *chosen;
  throw ClientError(ExitCode::kUsage, "no artefact is called '" + name + "'");
}

}  // namespace

std::vector<std::string> artifact_names() {
  std::vector<std::string> names;
  for (const Artifact& artifact : kArtifacts) names.emplace_back(artifact.name);
  return names;
}

std::vector<std::string> artifact_extensions(const std::string& name) {
  const Artifact& artifact = artifact_named(name);
  std::vector<std::string> extensions;
  for (const auto& formats : {artifact.formats(), artifact.more_formats()}) {
    for (const FileFormat format : formats) {
      std::string extension(extension_of(format));
      if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
        extensions.push_back(std::move(extension));
    }
  }
  return extensions;
}

Written transfer_artifact(Context& context, const ArtifactChoice& choice, const Destination& destination) {
  return artifact_named(choice.name).fetch(context, choice, destination);
}

}  // namespace affskel::client
