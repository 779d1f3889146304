#pragma once

#include <string>
#include <utility>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

/// "zucker-hummel, threshold 7".
std::string skeleton_params_text(const v1::SkeletonParams& params);

/// "fraction 0.1 of v0" or "volume 3e9".
std::string eroded_params_text(const v1::ErodedParams& params);

/// What people should know of a skeleton, as key and value.
std::vector<std::pair<std::string, std::string>> quality_lines(const v1::SkeletonQuality& quality);

}  // namespace affskel::client
