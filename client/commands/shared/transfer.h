#pragma once

#include <optional>
#include <string>

#include "client/base/error.h"
#include "client/commands/shared/context.h"
#include "client/files/format.h"

namespace affskel::client {

/// What a transfer wrote.
struct Written {
  Destination destination;
  std::string kind;         ///< "field", "divergence", "skeleton", "surface", "eroded", "mesh"
  std::string unit;         ///< what is counted: "point", "triangle" or "byte"
  std::uint64_t items = 0;  ///< how many
  v1::Job job;              ///< as the server sent it along
  std::optional<v1::SkeletonQuality> quality = {};  ///< of a skeleton, or a sheet of chords
  /// Of an eroded solid, mesh units cubed: what the surface encloses, or of points their share of the sample
  /// points times v0.
  std::optional<double> volume = {};
  std::string advice = {};  ///< why an eroded solid is empty
};

/// Each fetches one artefact and writes it atomically.  `skeleton`, `surface`: null = the job's own
/// parameters.  Those that have to be computed first are waited for, after the file was opened: a place that
/// cannot be written is known before the work is done.
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

/// Whether a file of this extension holds the surface of an eroded solid; else its points.
bool holds_eroded_surface(const Destination& destination);

/// Ends a command that wrote one artefact: warns when it is empty, and tells people and scripts what was
/// written.
void tell_result(Context& context, const Written& written);

/// Tells people and scripts what was written.
nlohmann::ordered_json written_json(const Written& written);
void tell_written(Console& console, const Written& written);

}  // namespace affskel::client
