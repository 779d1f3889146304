#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "client/base/stance.h"
#include "client/render/panel.h"

namespace affskel::client {

/// From where a solid is seen.  Pictures are orthographic and hold the whole solid, so that no distance is
/// needed.
struct Camera {
  std::string name;      ///< stands above the view
  double azimuth = 0;    ///< degrees: 0 from its front, 90 from the right of a viewer of its front
  double elevation = 0;  ///< degrees above the horizon, -90 .. 90
};

/// "front, side, back, left, top, bottom or oblique", for a help text.
std::string camera_words();

/// A name of camera_words(), or "AZIMUTH,ELEVATION" in degrees.
/// @throws ClientError kUsage for anything else.
Camera parse_camera(std::string_view text);

/// Front, side and top.
std::vector<Camera> usual_cameras();

/// The view of a solid that stands so.  Exact in multiples of 90 degrees.
View view_of(const Camera& camera, const core::Stance& stance);

}  // namespace affskel::client
