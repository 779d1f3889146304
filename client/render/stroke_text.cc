// The stroke font.  A glyph is a list of polylines separated by '|'; a point is two characters, x then y, on
// a grid of 6 units for the height of a capital: x = 0 .. 4, baseline y = 0, small letters 4 high, 'a' = -1
// and 'b' = -2 below the baseline.  A polyline whose points coincide is a dot.
#include "client/render/stroke_text.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "client/render/picture_letters.h"

namespace affskel::client {
namespace {

constexpr std::string_view kMissing = "0006464000";

constexpr std::array<std::string_view, 95> kGlyphs = {
    "",                                     // space
    "0602|0000",                            // !
    "0605|1615",                            // "
    "1016|3036|0242|0444",                  // #
    "453616050413334241301001|2726|202a",   // $
    "0046|0506161505|3031414030",           // %
    "40051626350201102042",                 // &
    "0605",                                 // '
    "16050110",                             // (
    "06151100",                             // )
    "1333|1432|1234",                       // *
    "0343|2521",                            // +
    "100a",                                 // ,
    "0333",                                 // -
    "0000",                                 // .
    "0046",                                 // /
    "163645413010010516",                   // 0
    "152620|1030",                          // 1
    "05163645440040",                       // 2
    "05163645443313|334241301001",          // 3
    "30360242",                             // 4
    "460603334241301001",                   // 5
    "36160501103041423303",                 // 6
    "064610",                               // 7
    "163645443313040516|1302011030414233",  // 8
    "10304145361605041343",                 // 9
    "0000|0303",                            // :
    "100a|1313",                            // ;
    "450341",                               // <
    "0242|0444",                            // =
    "054301",                               // >
    "05163645442322|2020",                  // ?
    "33322221314244361605011030",           // @
    "002640|1232",                          // A
    "00063645443303|3342413000",            // B
    "4536160501103041",                     // C
    "00062644422000",                       // D
    "46060040|0333",                        // E
    "460600|0333",                          // F
    "45361605011030414323",                 // G
    "0006|4046|0343",                       // H
    "0006",                                 // I
    "3631201001",                           // J
    "0006|4602|1340",                       // K
    "060040",                               // L
    "0006234640",                           // M
    "00064046",                             // N
    "163645413010010516",                   // O
    "00063645443303",                       // P
    "163645413010010516|2240",              // Q
    "00063645443303|2340",                  // R
    "453616050413334241301001",             // S
    "0646|2620",                            // T
    "060110304146",                         // U
    "062046",                               // V
    "0610243046",                           // W
    "0640|0046",                            // X
    "062346|2320",                          // Y
    "06460040",                             // Z
    "16060010",                             // [
    "0640",                                 // backslash
    "06161000",                             // ]
    "042644",                               // ^
    "0a4a",                                 // _
    "0615",                                 // `
    "3324140301102031|3430",                // a
    "0600|0314243331201001",                // b
    "3324140301102031",                     // c
    "3630|3324140301102031",                // d
    "02323324140301102031",                 // e
    "36261510|0434",                        // f
    "343a2b1b0a|3324140301102031",          // g
    "0600|0314243330",                      // h
    "0400|0606",                            // i
    "141a0b|1616",                          // j
    "0600|3401|1230",                       // k
    "0600",                                 // l
    "0400|03142320|23344340",               // m
    "0400|0314243330",                      // n
    "142433312010010314",                   // o
    "040b|0314243331201001",                // p
    "343b|3324140301102031",                // q
    "0400|021424",                          // r
    "33241403122231201001",                 // s
    "161120|0424",                          // t
    "0401102031|3430",                      // u
    "042044",                               // v
    "0410233044",                           // w
    "0430|0034",                            // x
    "0420|441b",                            // y
    "04340030",                             // z
    "26150413021120",                       // {
    "060a",                                 // |
    "06152413221100",                       // }
    "03142334",                             // ~
};

constexpr double kUnits = 6;  // grid units per capital height
constexpr double kGap = 1.8;  // between glyphs
constexpr double kSpaceWidth = 2;
constexpr double kStroke = 0.72;  // stroke width in grid units

// What is over and under letters, in the same way, but two units are one here: from the middle of a mark 3 to both
// sides, y = 0 .. 3 over the letter.
std::string_view mark_glyph(char mark) {
  switch (mark) {
    case '`':
      return "1341";
    case '\'':
      return "5321";
    case '^':
      return "113351";
    case 'v':
      return "133153";
    case '~':
      return "11234153";
    case ':':
      return "1212|5252";
    case 'o':
      return "3123334231";
    case '-':
      return "1252";
    case 'u':
      return "13214153";
    case '.':
      return "3232";
    case '"':
      return "3311|6341";
    case ',':
      return "3a4c1d";
    default:
      return "";
  }
}

std::string_view glyph_of(PictureLetter letter) {
  const auto code = static_cast<unsigned char>(letter.base);
  const std::string_view glyph = code >= 32 && code < 127 ? kGlyphs[code - 32] : kMissing;
  const bool dotted = letter.base == 'i' || letter.base == 'j';
  return dotted && letter.mark != 0 && letter.mark != ',' ? glyph.substr(0, glyph.find('|')) : glyph;
}

double glyph_width(std::string_view glyph) {
  if (glyph.empty()) return kSpaceWidth;
  double width = 0;
  std::size_t at = 0;
  while (at + 1 < glyph.size()) {
    if (glyph[at] == '|') {
      ++at;
      continue;
    }
    width = std::max(width, double(glyph[at] - '0'));
    at += 2;
  }
  return width;
}

double unit_y(char c) {
  return c >= 'a' ? -double(c - 'a' + 1) : double(c - '0');
}

double glyph_height(std::string_view glyph) {
  double height = 0;
  for (std::size_t at = 0; at + 1 < glyph.size(); at += glyph[at] == '|' ? 1 : 2)
    if (glyph[at] != '|') height = std::max(height, unit_y(glyph[at + 1]));
  return height;
}

void draw_glyph(Image& image, ScreenPoint at, std::string_view glyph, double unit, double width, Rgb colour) {
  bool pen_down = false;
  ScreenPoint last;
  for (std::size_t i = 0; i + 1 < glyph.size();) {
    if (glyph[i] == '|') {
      pen_down = false;
      ++i;
      continue;
    }
    const ScreenPoint next{at.x + unit * double(glyph[i] - '0'), at.y - unit * unit_y(glyph[i + 1])};
    if (pen_down) draw_stroke(image, last, next, width, colour);
    last = next;
    pen_down = true;
    i += 2;
  }
}

// The mark of a letter whose glyph starts at `at`.
void draw_mark(Image& image, ScreenPoint at, PictureLetter letter, double unit, double width, Rgb colour) {
  const std::string_view glyph = glyph_of(letter);
  const double wide = glyph_width(glyph), high = glyph_height(glyph);
  if (letter.mark == '/') {  // across, or of letters with a stem through that
    const bool across = letter.base == 'o' || letter.base == 'O';
    const double stem = letter.base == 'd' ? wide : 0;
    const double left = across ? -0.5 : stem - 1, right = across ? wide + 0.5 : stem + 1.2;
    const double low = across ? 0 : 0.45 * high, top = across ? high : 0.65 * high;
    draw_stroke(image, {at.x + left * unit, at.y - low * unit}, {at.x + right * unit, at.y - top * unit},
                width, colour);
    return;
  }
  const double half = 0.5 * unit;
  const double over = letter.mark == ',' ? 0 : high + 0.7;
  draw_glyph(image, {at.x + wide / 2 * unit - 3 * half, at.y - over * unit}, mark_glyph(letter.mark), half,
             width, colour);
}

// Distance of p from the segment a b.
double distance(ScreenPoint p, ScreenPoint a, ScreenPoint b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - (a.x + t * dx), p.y - (a.y + t * dy));
}

}  // namespace

void draw_stroke(Image& image, ScreenPoint from, ScreenPoint to, double width, Rgb colour) {
  const double reach = width / 2 + 1;
  const int x_end = static_cast<int>(std::ceil(std::max(from.x, to.x) + reach));
  const int y_end = static_cast<int>(std::ceil(std::max(from.y, to.y) + reach));
  for (int y = static_cast<int>(std::floor(std::min(from.y, to.y) - reach)); y <= y_end; ++y) {
    for (int x = static_cast<int>(std::floor(std::min(from.x, to.x) - reach)); x <= x_end; ++x) {
      if (!image.contains(x, y)) continue;
      const double outside = distance({x + 0.5, y + 0.5}, from, to) - width / 2;
      const auto cover = static_cast<float>(std::clamp(0.5 - outside, 0.0, 1.0));
      image.at(x, y) = mix(image.at(x, y), colour, cover);
    }
  }
}

double text_width(std::string_view text, double size) {
  double width = text.empty() ? 0 : -kGap;
  for (const PictureLetter letter : picture_letters(text)) width += glyph_width(glyph_of(letter)) + kGap;
  return width * size / kUnits;
}

void draw_text(Image& image, ScreenPoint at, std::string_view text, double size, Rgb colour, double bold) {
  const double unit = size / kUnits, width = bold * kStroke * unit;
  for (const PictureLetter letter : picture_letters(text)) {
    const std::string_view glyph = glyph_of(letter);
    draw_glyph(image, at, glyph, unit, width, colour);
    if (letter.mark != 0) draw_mark(image, at, letter, unit, width, colour);
    at.x += unit * (glyph_width(glyph) + kGap);
  }
}

}  // namespace affskel::client
