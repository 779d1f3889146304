#pragma once

#include <span>
#include <string>
#include <vector>

#include "client/commands/shared/context.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/written.h"

namespace affskel::client {

/// One artefact of a job, with the parameters of those that have some.
struct ArtifactChoice {
  std::string job;
  std::string name;          ///< one of artifact_names()
  SkeletonOptions skeleton;  ///< of skeleton, divergence and surface
  v1::ErodedParams eroded;   ///< no level: the default one
};

/// What can be fetched: "field", "divergence", "skeleton", "surface", "eroded", "mesh".
std::vector<std::string> artifact_names();

/// The formats of an artefact, as extensions with the dot, each once; the first is a good one to begin with.
/// @throws ClientError kUsage for an unknown name.
std::vector<std::string> artifact_extensions(const std::string& name);

/// Fetches it, computed first if need be, and writes it atomically.  Of the eroded solid the extension
/// chooses points or surface.  @throws ClientError kUsage for an unknown name.
Written transfer_artifact(Context& context, const ArtifactChoice& choice, const Destination& destination);

}  // namespace affskel::client
