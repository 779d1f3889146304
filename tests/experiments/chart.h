#pragma once

#include <string>
#include <utility>
#include <vector>

namespace affskel::experiments {

/// One line of a chart.
struct Line {
  std::string label;
  std::string colour;  ///< as SVG names it
  bool dashed = false;
  bool marked = false;                            ///< a dot at every point
  std::vector<std::pair<double, double>> points;  ///< x ascending, x > 0
};

/// An axis of a chart.
struct Axis {
  std::string label;
  double low = 0, high = 1;  ///< low < high; low > 0 when logarithmic
  bool logarithmic = false;  ///< ticks at powers of ten; else five steps from low to high
};

/// A place of the chart with words beside it.
struct Remark {
  double x = 0, y = 0;
  std::string text;
  bool upright = false;  ///< a line across the whole chart at x, the words at its top
};

/// Where the published work shows curves over scales that span many powers of ten, so do we.
struct Chart {
  std::string title;
  Axis x, y;
  std::vector<Line> lines;
  std::vector<Remark> remarks;
};

/// The chart as one self-contained SVG document; what lies outside the axes is cut off.
std::string svg_of(const Chart& chart);

}  // namespace affskel::experiments
