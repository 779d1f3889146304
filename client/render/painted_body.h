#pragma once

#include <string>
#include <vector>

#include "client/base/colour.h"
#include "client/render/legend.h"
#include "core/mesh/mesh.h"

namespace affskel::client {

/// Of what is drawn on a body or shines through it.
inline constexpr Rgb kInk{0.05f, 0.05f, 0.05f};

/// What is written beside a place within the body, where what the viewer sees before it has this colour.
struct Label {
  core::Vec3 place;
  std::string text;
  Rgb colour;
};

/// The body, its front opaque or nearly so, in colours of its own.
struct PaintedBody {
  core::Mesh mesh;
  std::vector<Rgb> colours;  ///< per triangle
  float opacity = 1;         ///< what lies behind it shines through the rest
  ColourScale scale;         ///< of these colours, or
  std::string title;         ///< of rows
  std::vector<ColourRow> rows;
  std::vector<Label> labels;  ///< where they have room, the first first
};

}  // namespace affskel::client
