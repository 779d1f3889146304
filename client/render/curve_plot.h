#pragma once

#include <string>
#include <utility>
#include <vector>

namespace affskel::client {

/// One line of a plot.
struct PlotCurve {
  std::string label;
  std::string colour;  ///< as SVG names it
  bool dashed = false;
  double width = 2;                               ///< pixels
  std::vector<std::pair<double, double>> points;  ///< x ascending; y 0 .. 1
};

/// Shares (0 .. 100 %) over a length or its square.
struct SharePlot {
  std::string title;
  std::vector<std::string> notes;  ///< lines below the title, at most two
  std::string x_label;
  double x_max = 1;   ///< > 0
  double marked = 0;  ///< an x with a line of its own; none unless 0 < marked <= x_max
  std::string marked_label;
  std::vector<PlotCurve> curves;
};

/// The plot as one self-contained SVG document: axes with ticks and labels, curves, legend.
std::string svg_of(const SharePlot& plot);

/// Ticks at 0, step, 2 step, ... up to `limit` > 0, with step 1, 2 or 5 times a power of ten and at most
/// `most` of them beside 0; 0 alone unless 1e-305 <= limit <= 1e305.
std::vector<double> round_ticks(double limit, int most);

}  // namespace affskel::client
