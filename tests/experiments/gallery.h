#pragma once

#include <string>
#include <vector>

#include "client/render/image.h"
#include "client/render/panel.h"
#include "core/mesh/mesh.h"

namespace affskel::experiments {

/// One thing to show.  Empty parts are left out.
struct Exhibit {
  std::vector<std::string> caption;          ///< lines above it
  core::Mesh solid;                          ///< drawn translucent
  std::vector<core::Vec3> points;            ///< drawn as balls
  std::vector<double> erosion;               ///< per point: E, for its colour
  double ball_radius = 0;                    ///< mesh units
  core::Mesh surface;                        ///< drawn opaque
  std::vector<core::Segment> segments = {};  ///< of curves of the surface, drawn as lines
};

enum class Side { kFront, kSide, kTop, kOblique };

struct GalleryOptions {
  std::vector<Side> sides = {Side::kFront, Side::kSide};  ///< views of each exhibit, beside each other
  int width = 1800;                                       ///< pixels
};

/// The exhibits beside each other, all at one scale, each centred on its solid (on its points when it has
/// none).  Orthographic; a body that faces -y with z up is seen from the front along +y.  Colours: dark
/// violet for E = 0 to yellow for the exhibit's largest, by the cube root of E, which is like a length.
client::Image gallery(const std::vector<Exhibit>& exhibits, const GalleryOptions& options = {});

}  // namespace affskel::experiments
