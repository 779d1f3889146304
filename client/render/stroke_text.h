#pragma once

#include <string_view>

#include "client/render/image.h"
#include "client/render/raster.h"

namespace affskel::client {

/// Draws a straight stroke with round ends, anti-aliased.  Coordinates in pixels.
void draw_stroke(Image& image, ScreenPoint from, ScreenPoint to, double width, Rgb colour);

/// Width of the text in pixels. @param size height of a capital letter in pixels.
double text_width(std::string_view text, double size);

/// Draws text with its baseline starting at `at`, in a stroke font of our own: printable ASCII, and what is written
/// by it with marks, see picture_letters; other characters become a box each. @param bold times as thick strokes as
/// usual.
void draw_text(Image& image, ScreenPoint at, std::string_view text, double size, Rgb colour, double bold = 1);

}  // namespace affskel::client
