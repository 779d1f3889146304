#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "client/base/error.h"
#include "client/files/read/input_file.h"
#include "client/files/read/mesh_defects.h"

namespace affskel::client {

/// What a mesh file is.
struct Inspection {
  /// Counts, and of a solid its volume, box, surfaces and notes; of any other mesh every defect.
  nlohmann::ordered_json facts;
  std::optional<core::Solid> solid;  ///< after the repair; none when the mesh bounds no solid
  std::optional<ClientError> error;  ///< then: why
};

/// Counts what is in the file, mends the mesh as `submit` does and looks for every kind of defect.
/// @param max_places of each kind that are listed. @param context asked whether to stop; may be null.
/// @throws ClientError kCancelled when the context asks to stop.
Inspection inspect(const InputFile& input, std::size_t max_places = kFewPlaces,
                   core::ExecutionContext* context = nullptr);

}  // namespace affskel::client
