#include "client/operations/fetch.h"

#include <algorithm>
#include <array>
#include <span>

#include "client/base/error.h"
#include "client/operations/artifact_files.h"

namespace affskel::client {
namespace {

std::span<const FileFormat> no_other() {
  return {};
}

// What can be fetched, in the order of the help.
struct Artifact {
  const char* name;
  std::span<const FileFormat> (*formats)();
  std::span<const FileFormat> (*more_formats)();  // of another form of it
  Fetched (*fetch)(Session& session, const FetchRequest& request);
};

constexpr std::array<Artifact, 9> kArtifacts = {{
    {"field", field_formats, no_other, fetch_field},
    {"divergence", divergence_formats, no_other, fetch_divergence},
    {"skeleton", skeleton_file_formats, no_other, fetch_skeleton},
    {"surface", surface_formats, no_other, fetch_surface},
    {"curve", curve_file_formats, no_other, fetch_curve},
    {"thickness", thickness_formats, no_other, fetch_thickness},
    {"eroded", surface_formats, skeleton_formats, fetch_eroded},
    {"mesh", surface_formats, no_other, fetch_submitted_mesh},
    {"source", surface_formats, no_other, fetch_source_mesh},
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

Fetched fetch(Session& session, const FetchRequest& request) {
  return artifact_named(request.artifact).fetch(session, request);
}

FileFormat open_field_format(const v1::Job& job) {
  const auto& frame = job.prepared().frame();
  for (int i = 0; i < frame.size(); ++i) {
    if (frame[i] != (i % 4 == 0 ? 1 : 0)) return FileFormat::kVts;
  }
  return FileFormat::kVti;
}

FetchRequest one_file(const v1::Job& job, const std::string& artifact, const std::string& path) {
  FetchRequest request;
  request.job = job.id();
  request.artifact = artifact;
  request.destination = {path};
  return request;
}

std::vector<FetchRequest> main_files(const v1::Job& job, const std::string& stem) {
  return {one_file(job, "field", stem + ".field" + std::string(extension_of(open_field_format(job)))),
          one_file(job, "skeleton", stem + ".skeleton.vtp"),
          one_file(job, "skeleton", stem + ".skeleton.ply")};
}

}  // namespace affskel::client
