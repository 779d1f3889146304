#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "client/base/error.h"
#include "client/connection/session.h"
#include "core/mesh/mesh.h"
#include "wire/artifact_kinds.h"

namespace affskel::client {

/// A request for an artefact without parameters.
v1::FetchArtifactRequest request_for(const std::string& job, v1::ArtifactKind kind);

/// An artefact that is there as soon as the job is prepared. @param what names it in an error.
/// @throws ClientError kInternal when it is no such message; std::logic_error when the kind has another.
template <typename Message>
Message fetch_message(Session& session, const std::string& job, v1::ArtifactKind kind, const char* what) {
  if (wire::find_artifact_kind(kind)->message != Message::descriptor()->full_name()) {
    throw std::logic_error(std::string("the ") + what + " is another message");
  }
  Message message;
  if (!message.ParseFromString(session.fetch_bytes(request_for(job, kind)))) {
    throw ClientError(ExitCode::kInternal, std::string("the server sent a damaged ") + what);
  }
  return message;
}

/// What the records of a job's finished field need to be read, see FieldDecoder.
struct FieldSource {
  v1::ArtifactKind kind;                     ///< FIELD or, of an infimum, REFINED
  std::optional<v1::Directions> directions;  ///< of FIELD

  const v1::Directions* set() const { return directions ? &*directions : nullptr; }
};

FieldSource field_source(Session& session, const v1::Job& job);

/// Runs a fetch that may have to wait for a worker; the session's listener hears of it after a moment.
/// @param what is computed.
std::string fetch_patiently(Session& session, const v1::FetchArtifactRequest& request,
                            v1::ArtifactHeader& header, const std::string& what);
v1::ArtifactHeader fetch_patiently(Session& session, const v1::FetchArtifactRequest& request,
                                   const std::function<std::unique_ptr<ArtifactSink>()>& make_sink,
                                   const std::string& what);

/// The mesh of a job, as it was submitted. @throws ClientError as parse_mesh.
core::Mesh fetch_mesh(Session& session, const std::string& job);

/// The sheet of an operator that gives one, whole: for pictures.  Waits while it is computed.
/// @throws ClientError kInternal when a corner is out of range or a vertex lacks E or its strength.
v1::TriangleMesh fetch_sheet(Session& session, const std::string& job, const v1::SkeletonParams& params);

/// The solid parted by the branches of its curve skeleton.  Waits while it is computed.
/// @param threshold of the curve; 0 = the default.
/// @throws ClientError as parse_solid_parts.
v1::SolidParts fetch_solid_parts(Session& session, const std::string& job, double threshold,
                                 v1::ArtifactHeader& header);

/// The surface of the eroded solid at a level, as a file of it holds it.  Waits while it is computed.
/// @param level as a share of v0, 0 < level < 1.
/// @throws ClientError kInternal when a corner is out of range or a vertex lacks E or its slope.
v1::TriangleMesh fetch_eroded_surface(Session& session, const std::string& job, double level);

}  // namespace affskel::client
