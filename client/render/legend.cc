#include "client/render/legend.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "client/base/scale_words.h"
#include "client/render/panel.h"
#include "client/render/stroke_text.h"

namespace affskel::client {
namespace {

// Heights, in heights of a capital letter.
constexpr double kScaleBar = 4.5, kLevelLine = 2.6, kColourBar = 8.2, kRow = 1.9;
constexpr double kSmall = 0.9;  // size of numbers

// 1, 2 or 5 times a power of ten, at most `limit`.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= limit) return factor * power;
  }
  return power;
}

void draw_scale_bar(Image& image, const Legend& legend, ScreenPoint at, double scale) {
  const double length = round_length(0.6 * legend.width() / scale);
  const double left = at.x, right = left + length * scale;
  const double y = at.y + 2.6 * legend.text, tick = 0.5 * legend.text;
  const double stroke = std::max(1.0, legend.text / 7);
  const Rgb ink = legend.ink.strong;
  draw_stroke(image, {left, y}, {right, y}, stroke, ink);
  draw_stroke(image, {left, y - tick}, {left, y + tick}, stroke, ink);
  draw_stroke(image, {right, y - tick}, {right, y + tick}, stroke, ink);
  const std::string label = base::to_text(length) + (length == 1 ? " unit" : " units");
  draw_text(image, {left, y - 1.2 * legend.text}, label, legend.text, ink);
}

// A square of a colour, and what it is.
void draw_row(Image& image, const Legend& legend, ScreenPoint at, const ColourRow& row) {
  const double side = 1.2 * legend.text;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int i = static_cast<int>(at.x) + x, j = static_cast<int>(at.y) + y;
      if (image.contains(i, j)) image.at(i, j) = row.colour;
    }
  }
  draw_text(image, {at.x + 1.6 * side, at.y + 1.1 * legend.text}, row.text, legend.text, legend.ink.strong);
}

void draw_rows(Image& image, const Legend& legend, ScreenPoint at) {
  draw_text(image, {at.x, at.y + legend.text}, legend.title, legend.text, legend.ink.strong);
  for (const ColourRow& row : legend.rows) {
    at.y += kRow * legend.text;
    draw_row(image, legend, at, row);
  }
}

void draw_ticks(Image& image, const Legend& legend, ScreenPoint at, double width) {
  for (int tick = 0; tick <= 4; ++tick) {
    const double t = tick / 4.0, share = legend.scale.cubic ? t * t * t : t;
    std::string label = tick == 0 ? "0" : base::rounded(share * legend.scale.highest, 2);
    if (tick == 4 && legend.scale.is_passed) label += "+";
    const double size = kSmall * legend.text, text = text_width(label, size);
    const double x = at.x + t * (width - 1);
    const double start = std::clamp(x - text / 2, at.x, std::max(at.x, at.x + width - text));
    draw_stroke(image, {x, at.y}, {x, at.y + 0.4 * legend.text}, std::max(1.0, legend.text / 9),
                legend.ink.faint);
    draw_text(image, {start, at.y + 1.7 * legend.text}, label, size, legend.ink.strong);
  }
}

void draw_colours(Image& image, const Legend& legend, ScreenPoint at) {
  draw_text(image, {at.x, at.y + legend.text}, legend.scale.title, legend.text, legend.ink.strong);
  draw_text(image, {at.x, at.y + 2.9 * legend.text}, legend.scale.note, kSmall * legend.text,
            legend.ink.faint);
  const double top = at.y + 3.6 * legend.text;
  const int width = static_cast<int>(legend.width()), height = static_cast<int>(1.1 * legend.text);
  for (int x = 0; x < width; ++x) {
    const Rgb colour = viridis(float(x) / float(std::max(1, width - 1)));
    for (int y = 0; y < height; ++y) {
      const int i = static_cast<int>(at.x) + x, j = static_cast<int>(top) + y;
      if (image.contains(i, j)) image.at(i, j) = colour;
    }
  }
  draw_ticks(image, legend, {at.x, std::floor(top) + height}, width);
}

}  // namespace

bool is_dark(Rgb background) {
  return 0.3f * background.r + 0.6f * background.g + 0.1f * background.b < 0.5f;
}

Ink ink_on(Rgb background) {
  if (is_dark(background)) return {{0.91f, 0.93f, 0.95f}, {0.66f, 0.71f, 0.76f}};
  return {{0.13f, 0.15f, 0.18f}, {0.45f, 0.48f, 0.52f}};
}

ColourScale erosion_scale(double highest, double volume) {
  return {volume > 0 ? std::string(kScaleTitle) : "Erosion level E", std::string(kScaleNote),
          volume > 0 ? 100 * highest / volume : highest, true};
}

double Legend::width() const {
  double width = std::max(text_width(kScaleNote, kSmall * text), 2.5 * text + text_width(level, text));
  width = std::max(width, text_width(title, text));
  for (const ColourRow& row : rows) width = std::max(width, 2.5 * text + text_width(row.text, text));
  return width;
}

double Legend::height() const {
  const double list = rows.empty() ? 0 : 2 + kRow * static_cast<double>(rows.size());
  return text * (kScaleBar + (level.empty() ? 0 : kLevelLine) + list + (scale.highest > 0 ? kColourBar : 0));
}

void draw_legend(Image& image, const Legend& legend, ScreenPoint at, double scale) {
  draw_scale_bar(image, legend, at, scale);
  at.y += kScaleBar * legend.text;
  if (!legend.level.empty()) {
    draw_row(image, legend, at, {kErodedGlass.light, legend.level});
    at.y += kLevelLine * legend.text;
  }
  if (!legend.rows.empty()) draw_rows(image, legend, at);
  if (legend.scale.highest > 0) draw_colours(image, legend, at);
}

}  // namespace affskel::client
