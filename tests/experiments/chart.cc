#include "chart.h"

#include <cmath>
#include <cstddef>

#include "report.h"

namespace affskel::experiments {
namespace {

// Pixels.  The legend stands to the right of the axes, where no curve can be.
constexpr double kWidth = 960, kHeight = 480;
constexpr double kLeft = 80, kRight = 690, kTop = 50, kBottom = 420;

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return safe;
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) {}

  std::string run() {
    svg_ =
        format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" viewBox=\"0 0 %g %g\" ",
               kWidth, kHeight, kWidth, kHeight) +
        "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" font-size=\"13\" fill=\"#222\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" +
        format("<clipPath id=\"axes\"><rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\"/></clipPath>\n",
               kLeft, kTop, kRight - kLeft, kBottom - kTop);
    text(kLeft, 28, "font-size=\"16\"", chart_.title);
    draw_axes();
    for (const Line& line : chart_.lines) draw(line);
    draw_legend();
    for (const Remark& remark : chart_.remarks) draw(remark);
    return svg_ + "</svg>\n";
  }

 private:
  static double share(const Axis& axis, double value) {
    if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
    return std::log(value / axis.low) / std::log(axis.high / axis.low);
  }
  double x(double value) const { return kLeft + share(chart_.x, value) * (kRight - kLeft); }
  double y(double value) const { return kBottom - share(chart_.y, value) * (kBottom - kTop); }

  void text(double at_x, double at_y, const std::string& style, const std::string& words) {
    svg_ +=
        format("<text x=\"%.1f\" y=\"%.1f\" %s>", at_x, at_y, style.c_str()) + escaped(words) + "</text>\n";
  }
  void line(double x1, double y1, double x2, double y2, const std::string& style) {
    svg_ +=
        format("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>\n", x1, y1, x2, y2, style.c_str());
  }

  static std::vector<double> ticks(const Axis& axis) {
    std::vector<double> values;
    if (axis.logarithmic) {
      const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
      for (int p = first; std::pow(10.0, p) <= axis.high * (1 + 1e-9); ++p)
        values.push_back(std::pow(10.0, p));
    } else {
      for (int s = 0; s <= 5; ++s) values.push_back(axis.low + s * (axis.high - axis.low) / 5);
    }
    return values;
  }

  // Powers of ten from 1000 up and below 0.01 with an exponent.
  static std::string tick_label(double value) {
    if (value == 0 || (value >= 0.01 && value < 10000)) return format("%g", value);
    return format("1e%d", static_cast<int>(std::lround(std::log10(value))));
  }

  void draw_axes() {
    for (const double value : ticks(chart_.x)) {
      line(x(value), kTop, x(value), kBottom, "stroke=\"#e4e4e4\"");
      text(x(value), kBottom + 20, "text-anchor=\"middle\"", tick_label(value));
    }
    for (const double value : ticks(chart_.y)) {
      line(kLeft, y(value), kRight, y(value), "stroke=\"#e4e4e4\"");
      text(kLeft - 8, y(value) + 4, "text-anchor=\"end\"", tick_label(value));
    }
    svg_ += format("<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"none\" stroke=\"#444\"/>\n",
                   kLeft, kTop, kRight - kLeft, kBottom - kTop);
    text((kLeft + kRight) / 2, kBottom + 44, "text-anchor=\"middle\"", chart_.x.label);
    const double middle = (kTop + kBottom) / 2;
    text(22, middle, format("text-anchor=\"middle\" transform=\"rotate(-90 22 %g)\"", middle),
         chart_.y.label);
  }

  static std::string stroke(const Line& line) {
    return "stroke=\"" + line.colour + "\" stroke-width=\"2\" fill=\"none\"" +
           (line.dashed ? " stroke-dasharray=\"6 4\"" : "");
  }

  void draw(const Line& line) {
    svg_ += "<g clip-path=\"url(#axes)\"><polyline " + stroke(line) + " points=\"";
    for (const auto& [px, py] : line.points) svg_ += format("%.1f,%.1f ", x(px), y(py));
    svg_ += "\"/></g>\n";
    if (!line.marked) return;
    for (const auto& [px, py] : line.points) {
      svg_ += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", x(px), y(py),
                     line.colour.c_str());
    }
  }

  void draw_legend() {
    double at = kTop + 12;
    for (const Line& entry : chart_.lines) {
      line(kRight + 16, at - 4, kRight + 46, at - 4, stroke(entry));
      text(kRight + 54, at, "", entry.label);
      at += 22;
    }
  }

  void draw(const Remark& remark) {
    if (remark.upright) {
      line(x(remark.x), kTop, x(remark.x), kBottom, "stroke=\"#888\" stroke-dasharray=\"2 3\"");
      text(x(remark.x) + 5, kBottom - 10, "fill=\"#555\"", remark.text);
      return;
    }
    svg_ +=
        format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5\" fill=\"none\" stroke=\"#b00\" stroke-width=\"2\"/>\n",
               x(remark.x), y(remark.y));
    text(x(remark.x) - 10, y(remark.y) + 18, "fill=\"#b00\" text-anchor=\"end\"", remark.text);
  }

  const Chart& chart_;
  std::string svg_;
};

}  // namespace

std::string svg_of(const Chart& chart) {
  return Drawing(chart).run();
}

}  // namespace affskel::experiments
