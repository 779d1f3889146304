#include "client/render/curve_plot.h"

#include <gtest/gtest.h>

namespace affskel::client {
namespace {

TEST(CurvePlot, TicksAreRound) {
  EXPECT_EQ(round_ticks(10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(round_ticks(974, 8), (std::vector<double>{0, 200, 400, 600, 800}));
  EXPECT_EQ(round_ticks(1e8, 8).size(), 6u);
  for (const double limit : {1e-7, 0.3, 1., 7.7, 99., 1e12}) {
    const std::vector<double> ticks = round_ticks(limit, 8);
    EXPECT_GE(ticks.size(), 4u) << limit;
    EXPECT_LE(ticks.size(), 9u) << limit;
    EXPECT_LE(ticks.back(), limit * (1 + 1e-6));
  }
}

TEST(CurvePlot, TicksEndWhereverTheLimitIs) {
  EXPECT_EQ(round_ticks(1e-300, 8).size(), 6u);
  EXPECT_EQ(round_ticks(1e300, 8).size(), 6u);
  for (const double limit : {5e-324, 1e-310, 1e308, 0.0, -1.0}) {
    EXPECT_EQ(round_ticks(limit, 8), (std::vector<double>{0})) << limit;
  }
}

TEST(CurvePlot, HoldsEveryCurveAndNoMarkupOfItsLabels) {
  SharePlot plot;
  plot.title = "a < b & \"c\"";
  plot.notes = {std::string(300, 'n')};
  plot.x_label = "r";
  plot.x_max = 4;
  plot.marked = 1;
  plot.marked_label = "r = 1";
  plot.curves = {{"one", "red", false, 2, {{0, 0}, {4, 1}}}, {"<two>", "blue", true, 2, {{0, 1}, {4, 1}}}};
  const std::string svg = svg_of(plot);
  EXPECT_EQ(svg.substr(0, 4), "<svg");
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_EQ(svg.find("<two>"), std::string::npos);
  EXPECT_EQ(svg.find(std::string(200, 'n')), std::string::npos);
  EXPECT_NE(svg.find("r = 1"), std::string::npos);
  // From the lower left to the upper right corner of the axes, 0 at the bottom.
  EXPECT_NE(svg.find("points=\"70,490 770,150 \""), std::string::npos);
  EXPECT_NE(svg.find("points=\"70,150 770,150 \""), std::string::npos);
}

}  // namespace
}  // namespace affskel::client
