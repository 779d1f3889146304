#pragma once

#include "client/render/image.h"
#include "client/render/painted_body.h"
#include "client/render/panel.h"

namespace affskel::client {

/// Writes the body's labels to the right of their places, but for those that would run into one before them.
/// @param corner of the panel in the image. @param size height of a capital letter, pixels.
void draw_labels(const PaintedBody& body, const Panel& panel, ScreenPoint corner, double size, Image& image);

}  // namespace affskel::client
