#pragma once

#include <string>

#include "affskel/v1/types.pb.h"
#include "client/base/notice.h"
#include "client/connection/session.h"

namespace affskel::client {

/// The solid in numbers.
struct Measures {
  v1::Job job;
  v1::SolidParts solid;  ///< as a whole, and its parts
  double curve_length = 0;
  Notices notices = {};
};

/// Measures a finished job by its curve skeleton, which is computed first if need be.
/// @param threshold of the curve, its least limb in radii; 0 = the default.
/// @throws ClientError as Session::fetch.
Measures measure(Session& session, const std::string& job, double threshold);

}  // namespace affskel::client
