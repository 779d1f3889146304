#pragma once

#include <string>
#include <vector>

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

/// What viridis stands for.
struct ColourScale {
  std::string title, note;
  double highest = 0;      ///< of the last colour, as it is labelled; 0: there is no scale
  bool cubic = false;      ///< the colour follows the cube root
  bool is_passed = false;  ///< the last colour stands for more, too
};

/// That of E. @param volume v0, of which E is labelled as a share; 0: E itself is.
ColourScale erosion_scale(double highest, double volume);

/// What single colours stand for.
struct ColourRow {
  Rgb colour;
  std::string text;
};

/// Beside the views of a picture: the scale bar, what the eroded solid is, the scale of colours or their list.
struct Legend {
  double text = 10;  ///< height of a capital letter, pixels
  ColourScale scale;
  std::string title;            ///< of the rows
  std::vector<ColourRow> rows;  ///< may be empty
  std::string level;            ///< of the eroded solid; empty: none is drawn
  Ink ink;

  double width() const;   ///< pixels
  double height() const;  ///< pixels
};

/// @param at the upper left corner. @param scale pixels per mesh unit.
void draw_legend(Image& image, const Legend& legend, ScreenPoint at, double scale);

}  // namespace affskel::client
