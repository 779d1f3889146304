#pragma once

#include <string>

#include "client/render/image.h"
#include "client/render/raster.h"

namespace affskel::client {

/// Colours of what is written on a background.
struct Ink {
  Rgb strong, faint;
};

/// Whether light ink is needed.
bool is_dark(Rgb background);

Ink ink_on(Rgb background);

/// Beside the views of a picture: the scale bar, what the eroded solid is, the scale of colours.
struct Legend {
  double text = 10;    ///< height of a capital letter, pixels
  double highest = 0;  ///< E of the last colour, mesh units cubed; 0: no scale of colours
  double volume = 0;   ///< v0, of which E is labelled as a share; 0: E itself is
  std::string level;   ///< of the eroded solid; empty: none is drawn
  Ink ink;

  double width() const;   ///< pixels
  double height() const;  ///< pixels
};

/// @param at the upper left corner. @param scale pixels per mesh unit.
void draw_legend(Image& image, const Legend& legend, ScreenPoint at, double scale);

}  // namespace affskel::client
