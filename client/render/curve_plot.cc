#include "client/render/curve_plot.h"

#include <cmath>

#include "base/number_text.h"
#include "base/utf8.h"
#include "client/text/markup_text.h"
#include "client/text/printable.h"

namespace affskel::client {
namespace {

// Pixels.  The legend stands above the axes, where no curve can be.
constexpr double kWidth = 800, kHeight = 560;
constexpr double kLeft = 70, kRight = 770, kTop = 150, kBottom = 490;

// A place on the picture, to a hundredth of a pixel.
std::string pixel(double value) {
  return base::to_text(std::round(100 * value) / 100);
}

// What fits beside the left margin; the end of a file's name tells more than its beginning.
std::string shortened(const std::string& words) {
  constexpr std::size_t kMaxBytes = 95, kHead = 20;
  if (words.size() <= kMaxBytes) return words;
  const std::size_t head = base::truncate_utf8(words, kHead).size();
  const std::size_t tail = base::truncate_utf8(words, words.size() - (kMaxBytes - kHead - 5)).size();
  return words.substr(0, head) + " ... " + words.substr(tail);
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + pixel(x1) + "\" y1=\"" + pixel(y1) + "\" x2=\"" + pixel(x2) + "\" y2=\"" +
         pixel(y2) + "\" " + style + "/>\n";
}

std::string text(double x, double y, const std::string& style, const std::string& words) {
  return "<text x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" " + style + ">" +
         markup_text(printable(words)) + "</text>\n";
}

class Drawing {
 public:
  explicit Drawing(const SharePlot& plot) : plot_(plot) {}

  std::string run() {
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + pixel(kWidth) + "\" height=\"" +
           pixel(kHeight) + "\" viewBox=\"0 0 " + pixel(kWidth) + " " + pixel(kHeight) +
           "\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"14\" "
           "fill=\"#222\">\n<title>" +
           markup_text(printable(plot_.title)) +
           "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    svg_ += text(kLeft, 28, "font-size=\"17\" font-weight=\"bold\"", plot_.title);
    for (std::size_t i = 0; i < plot_.notes.size(); ++i) {
      svg_ += text(kLeft, 50 + 18 * static_cast<double>(i), "font-size=\"13\" fill=\"#555\"",
                   shortened(plot_.notes[i]));
    }
    draw_axes();
    draw_marked();
    for (const PlotCurve& curve : plot_.curves) draw_curve(curve);
    draw_legend();
    return svg_ + "</svg>\n";
  }

 private:
  double across(double x) const { return kLeft + (kRight - kLeft) * x / plot_.x_max; }
  static double up(double y) { return kBottom - (kBottom - kTop) * y; }

  void draw_axes() {
    for (const double x : round_ticks(plot_.x_max, 8)) {
      svg_ += line(across(x), kTop, across(x), kBottom, "stroke=\"#e3e3e3\"");
      svg_ += line(across(x), kBottom, across(x), kBottom + 5, "stroke=\"#222\"");
      svg_ += text(across(x), kBottom + 21, "text-anchor=\"middle\"", base::rounded(x, 6));
    }
    for (int share = 0; share <= 100; share += 20) {
      const double y = up(share / 100.0);
      svg_ += line(kLeft, y, kRight, y, "stroke=\"#e3e3e3\"");
      svg_ += line(kLeft - 5, y, kLeft, y, "stroke=\"#222\"");
      svg_ += text(kLeft - 9, y + 5, "text-anchor=\"end\"", std::to_string(share));
    }
    svg_ += line(kLeft, kBottom, kRight, kBottom, "stroke=\"#222\"");
    svg_ += line(kLeft, kTop, kLeft, kBottom, "stroke=\"#222\"");
    svg_ += text((kLeft + kRight) / 2, kBottom + 46, "text-anchor=\"middle\"", plot_.x_label);
    svg_ += "<g transform=\"translate(20 " + pixel((kTop + kBottom) / 2) + ") rotate(-90)\">" +
            text(0, 0, "text-anchor=\"middle\"", "share of the points, %") + "</g>\n";
  }

  void draw_marked() {
    if (!(plot_.marked > 0) || plot_.marked > plot_.x_max) return;
    const double x = across(plot_.marked);
    svg_ += line(x, kTop, x, kBottom, "stroke=\"#888\" stroke-dasharray=\"2 3\"");
    // Beside the line, on the side that has room.
    const bool left = x > kRight - 120;
    svg_ += text(left ? x - 5 : x + 5, kBottom - 8,
                 std::string("font-size=\"12\" fill=\"#555\"") + (left ? " text-anchor=\"end\"" : ""),
                 plot_.marked_label);
  }

  static std::string stroke(const PlotCurve& curve) {
    return "stroke=\"" + curve.colour + "\" stroke-width=\"" + pixel(curve.width) + "\"" +
           (curve.dashed ? " stroke-dasharray=\"7 5\"" : "");
  }

  void draw_curve(const PlotCurve& curve) {
    svg_ += "<polyline fill=\"none\" stroke-linejoin=\"round\" " + stroke(curve) + " points=\"";
    for (const auto& [x, y] : curve.points) svg_ += pixel(across(x)) + "," + pixel(up(y)) + " ";
    svg_ += "\"/>\n";
  }

  void draw_legend() {
    for (std::size_t i = 0; i < plot_.curves.size(); ++i) {
      const double x = i % 2 == 0 ? kLeft : (kLeft + kRight) / 2;
      const double y = 98 + 23 * static_cast<double>(i / 2);
      svg_ += line(x, y - 5, x + 34, y - 5, stroke(plot_.curves[i]));
      svg_ += text(x + 42, y, "", plot_.curves[i].label);
    }
  }

  const SharePlot& plot_;
  std::string svg_;
};

}  // namespace

std::string svg_of(const SharePlot& plot) {
  return Drawing(plot).run();
}

std::vector<double> round_ticks(double limit, int most) {
  // Nearer to the ends of the range of a double the steps would be 0 or infinite.
  if (!(limit >= 1e-305 && limit <= 1e305)) return {0};
  const double power = std::pow(10, std::floor(std::log10(limit / most)));
  double step = 10 * power;
  for (const double factor : {1, 2, 5}) {
    if (factor * power * most >= limit) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  for (int i = 0; i <= most && i * step <= limit * (1 + 1e-9); ++i) ticks.push_back(i * step);
  return ticks;
}

}  // namespace affskel::client
