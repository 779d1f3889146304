#pragma once

#include <optional>
#include <string>

#include "client/commands/context.h"
#include "client/error.h"
#include "client/exporters/format.h"

namespace affskel::client {

/// What a transfer wrote.
struct Written {
  Destination destination;
  std::string kind;         ///< "field", "divergence", "skeleton", "surface", "eroded", "mesh"
  std::string unit;         ///< what is counted: "points", "triangles" or "bytes"
  std::uint64_t items = 0;  ///< how many
  v1::Job job;              ///< as the server sent it along
  std::optional<v1::SkeletonQuality> quality = {};  ///< of a skeleton, or a sheet of chords
  /// Of an eroded solid, mesh units cubed: what the surface encloses, or of points their share of the sample
  /// points times v0.
  std::optional<double> volume = {};
  std::string advice = {};  ///< why an eroded solid is empty
};

/// Each fetches one artefact and writes it atomically.  `skeleton`, `surface`: null = the job's own
/// parameters.  Those that have to be computed first are waited for,
/// after the file was opened: a place that cannot be written is known before the work is done.
Written transfer_field(Context& context, const std::string& job, const Destination& destination);
Written transfer_skeleton(Context& context, const std::string& job, const v1::SkeletonParams* skeleton,
                          const Destination& destination);
Written transfer_surface(Context& context, const std::string& job, const v1::SurfaceParams* surface,
                         const Destination& destination);
Written transfer_divergence(Context& context, const std::string& job, const v1::SkeletonParams* skeleton,
                            const Destination& destination);
Written transfer_eroded_points(Context& context, const std::string& job, const v1::ErodedParams& params,
                               const Destination& destination);
Written transfer_eroded_surface(Context& context, const std::string& job, const v1::ErodedParams& params,
                                const Destination& destination);
Written transfer_mesh(Context& context, const std::string& job, const Destination& destination);

v1::FetchArtifactRequest request_for(const std::string& job, v1::ArtifactKind kind);

/// An artefact that is there as soon as the job is prepared. @param what names it in an error.
/// @throws ClientError kInternal when it is no such message.
template <typename Message>
Message fetch_message(Context& context, const std::string& job, v1::ArtifactKind kind, const char* what) {
  Message message;
  if (!message.ParseFromString(context.session().fetch_bytes(request_for(job, kind)))) {
    throw ClientError(ExitCode::kInternal, std::string("the server sent a damaged ") + what);
  }
  return message;
}

/// Runs a fetch that may have to wait for a worker; says so after a moment.
std::string fetch_patiently(Context& context, const v1::FetchArtifactRequest& request,
                            v1::ArtifactHeader& header, const std::string& what);

/// Tells people and scripts what was written.
nlohmann::ordered_json written_json(const Written& written);
void tell_written(Console& console, const Written& written);

}  // namespace affskel::client
