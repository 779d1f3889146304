#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "affskel/v1/types.pb.h"
#include "client/cli/console.h"
#include "client/commands/shared/context.h"
#include "client/files/format.h"

namespace affskel::client {

/// An artefact of a job that was written into a file.
struct Written {
  Destination destination;
  std::string kind;            ///< "field", "divergence", "skeleton", "surface", "eroded", "mesh"
  std::string unit;            ///< what is counted: "point", "triangle" or "byte"
  std::uint64_t items = 0;     ///< how many
  v1::Job job;                 ///< as the server sent it along
  std::uint64_t segments = 0;  ///< of the curves of a surface
  std::optional<v1::SkeletonQuality> quality = {};  ///< of a skeleton, or a sheet
  /// Of an eroded solid, mesh units cubed: what the surface encloses, or of points their share of the sample
  /// points times v0.
  std::optional<double> volume = {};
  std::string advice = {};  ///< why an eroded solid is empty
};

/// Ends a command that wrote one artefact: warns when it is empty, and tells people and scripts what was
/// written.
void tell_result(Context& context, const Written& written);

/// Tells people and scripts what was written.
nlohmann::ordered_json written_json(const Written& written);
void tell_written(Console& console, const Written& written);

}  // namespace affskel::client
