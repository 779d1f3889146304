#pragma once

#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "client/base/notice.h"
#include "client/connection/session.h"
#include "core/base/vec3.h"

namespace affskel::client {

/// A branch of the curve skeleton and the part of the solid that is nearest to it.  Mesh units.
struct MeasuredPart {
  std::string kind;  ///< "limb": one end is free; "line": both; "link": none; "loop": it closes
  core::Vec3 from, to;
  double length = 0, straight_length = 0;
  double volume = 0, volume_share = 0;  ///< by the sample points
  double mean_radius = 0, least_radius = 0,
         greatest_radius = 0;  ///< of circles as large as the optimal sections
};

/// The solid in numbers.
struct Measures {
  v1::Job job;
  double volume = 0, surface_area = 0;
  double curve_length = 0;
  v1::SkeletonQuality curve;        ///< of the curve skeleton
  std::vector<MeasuredPart> parts;  ///< the greatest volume first, equal ones by where they lie
  Notices notices = {};
};

/// Measures a finished job by its curve skeleton, which is computed first if need be.
/// @param threshold of the curve, its least limb in radii; 0 = the default.
/// @throws ClientError as Session::fetch.
Measures measure(Session& session, const std::string& job, double threshold);

}  // namespace affskel::client
