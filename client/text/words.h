#pragma once

#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

// The words of the command line for the protocol's enumerations.

/// "queued", "running", "done", "failed", "cancelled"; "unknown" for anything else.
std::string state_word(v1::JobState state);
/// "prepare", "erode", "derive", "complete"; "unknown" for anything else.
std::string stage_word(v1::JobStage stage);
/// "axis", "pca", "obb" or "affine".
std::string frame_word(v1::Frame frame);

/// The operators' names on the command line, the default first.
const std::vector<std::string>& operator_names();

/// The operator of that name.  @throws ClientError kUsage naming the possible ones.
v1::Operator operator_named(const std::string& name);

/// Its name; that of the default, "zucker-hummel", when none is specified or it is unknown.
std::string operator_word(v1::Operator which);

}  // namespace affskel::client
