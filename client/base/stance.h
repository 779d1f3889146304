#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "affskel/v1/types.pb.h"
#include "core/mesh/mesh.h"
#include "core/solid/stance.h"

namespace affskel::client {

/// How a user says that a solid stands.
struct StanceChoice {
  std::optional<core::AxisDirection>
      up;  ///< absent: what is kept with the job or, `by_shape`, what the shape tells
  std::optional<core::AxisDirection> front;  ///< absent: what the shape tells; only with `up`
  bool by_shape = false;
};

/// "UP", "UP,FRONT" or "shape", the directions as x, -x, y, -y, z or -z.
/// @throws ClientError kUsage for anything else, and for a front along the axis that is up.
StanceChoice parse_stance(std::string_view text);

/// "x", "-x", ...
std::string direction_text(const core::AxisDirection& direction);

/// "z up, facing -y".
std::string stance_text(const core::Stance& stance);

/// What is kept with a job; absent: as its shape tells.
std::optional<core::Stance> kept_stance(const v1::Job& job);

/// The same on the wire.
v1::Stance stance_message(const core::Stance& stance);

/// The stance of a job's solid in pictures.
core::Stance stance_of(const StanceChoice& choice, const v1::Job& job, const core::Mesh& mesh);

}  // namespace affskel::client
