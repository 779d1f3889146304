#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>
#include <string>

#include "chart.h"
#include "core/shapes/shapes.h"
#include "gallery.h"
#include "job.h"
#include "report.h"
#include "sheet.h"
#include "similarity_curves.h"

namespace affskel::experiments {
namespace {

TEST(Report, SaysTimesAsPeopleDo) {
  EXPECT_EQ(duration(0.0144), "14 ms");
  EXPECT_EQ(duration(0.42), "0.42 s");
  EXPECT_EQ(duration(334), "5 min 34 s");
  EXPECT_EQ(duration(105 * 60), "1 h 45 min");
  EXPECT_EQ(duration(180 * 3600), "180 h");
}

TEST(Report, LongTextsAreNotCut) {
  const std::string text(5000, 'x');
  EXPECT_EQ(format("%s!", text.c_str()), text + "!");
}

TEST(Report, AFigureThatIsNoNumberFails) {
  EXPECT_TRUE((Check{"", 1, 0, 1}.holds()));
  EXPECT_FALSE((Check{"", 1.5, 0, 1}.holds()));
  EXPECT_FALSE((Check{"", std::numeric_limits<double>::quiet_NaN(), 0, 1}.holds()));
  EXPECT_FALSE((Check{"", std::numeric_limits<double>::infinity(), 0, 1}.holds()));
}

TEST(Report, PageShowsWhatItHolds) {
  const std::filesystem::path directory = testing::TempDir() + "affskel_experiments_report";
  Report report(directory);
  report.section("A section");
  report.table({{"a", "b"}, {{"1", "2"}}});
  report.drawing("figure", "<svg/>", "caption");
  report.compare({"solid", "old", "new", "agrees"});
  report.expect("figure", 3, 0, 1);
  report.write("# Heading\n");
  EXPECT_FALSE(report.all_hold());
  std::ostringstream page;
  page << std::ifstream(directory / "REPORT.md").rdbuf();
  for (const char* part :
       {"# Heading\n", "| solid | old | new | agrees |", "## A section", "| a | b |\n|---|--:|\n| 1 | 2 |",
        "![caption](figure.svg)", "| figure | 3 | 0 | 1 | **no** |"}) {
    EXPECT_NE(page.str().find(part), std::string::npos) << part;
  }
  EXPECT_TRUE(std::filesystem::exists(directory / "figure.svg"));
  std::filesystem::remove_all(directory);
}

// A point's place on the chart: low at the left and bottom, high at the right and top, logarithms between.
TEST(Chart, PlacesPointsOnTheirAxes) {
  Chart chart;
  chart.title = "a < b & c";
  chart.x = {"x", 1, 100, true};
  chart.y = {"y", 0, 10, false};
  chart.lines = {{"line", "red", false, false, {{1, 0}, {10, 5}, {100, 10}}}};
  const std::string svg = svg_of(chart);
  EXPECT_NE(svg.find("points=\"80.0,420.0 385.0,235.0 690.0,50.0 \""), std::string::npos) << svg;
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
}

TEST(SquaredText, HasTwoDigits) {
  EXPECT_EQ(squared_text(1.2e5), "1.2e5");
  EXPECT_EQ(squared_text(3e4), "3e4");
  EXPECT_EQ(squared_text(1e8), "1e8");
  EXPECT_EQ(squared_text(1.08e6), "1.1e6");
}

Job torus_job() {
  return compute(core::make_torus(3000, 1200, 256), {400, "triangles", core::FrameKind::kAxis, 1});
}

TEST(Job, FieldIsInMeshUnits) {
  const Job job = torus_job();
  const Cloud all = all_points(job);
  // A torus of radii 3000 and 1200 has the volume 2 pi^2 R r^2, and 256 triangles lack some of it.
  const double smooth = 2 * std::pow(std::acos(-1.0), 2) * 3000 * 1200 * 1200;
  EXPECT_NEAR(job.solid.volume / smooth, 0.87, 0.03);
  EXPECT_NEAR(static_cast<double>(all.size()) * std::pow(400.0, 3) / job.solid.volume, 1, 0.05);
  EXPECT_GT(job.highest_share(), 0.1);
  EXPECT_LE(job.highest_share(), 0.5);
}

TEST(Job, PiecesAgreeWithTheTopologyOfVoxels) {
  const Job job = torus_job();
  const std::vector<double> divergence = divergence_of(job, core::ShockOperator::kZuckerHummel);
  for (const double threshold : {4.0, 7.0, 9.0, 12.0}) {
    const Cloud cloud = thresholded(job, divergence, threshold);
    const std::vector<std::size_t> pieces = piece_sizes(job, cloud);
    EXPECT_EQ(pieces.size(), topology(job, cloud).components) << threshold;
    EXPECT_EQ(std::accumulate(pieces.begin(), pieces.end(), std::size_t{0}), cloud.size());
    EXPECT_TRUE(std::is_sorted(pieces.rbegin(), pieces.rend()));
  }
}

// Computed in a frame of its own and mapped back, the sheet still lies in the torus's plane.
TEST(Sheet, IsMappedBackFromItsFrame) {
  const Job job = compute(core::make_torus(3000, 1200, 256), {300, "triangles", core::FrameKind::kAffine, 1});
  const Sheet sheet = chord_sheet_of(job);
  ASSERT_FALSE(sheet.mesh.points.empty());
  EXPECT_EQ(sheet.betti, (core::BettiNumbers{1, 1, 0}));
  for (const core::Vec3& p : sheet.points.place) {
    EXPECT_NEAR(p.z, 0, 1200.0 / 6);  // the frame narrows all turns, so that facets beside the plane count
    const double round = std::sqrt(p.x * p.x + p.y * p.y);
    EXPECT_GT(round, 1500);
    EXPECT_LT(round, 3500);
  }
}

// The middle of a view is the middle of its solid, and nothing is drawn in the corners.
TEST(Gallery, ShowsTheSurfaceInTheMiddle) {
  const Exhibit exhibit{{"ball"}, {}, {}, {}, 0, core::make_sphere(1, 320)};
  const client::Image image = gallery({exhibit}, {{Side::kFront}, 400});
  const client::Rgb middle = image.at(200, image.height() - 200);
  EXPECT_GT(middle.r, middle.b + 0.2f);
  EXPECT_EQ(image.at(2, image.height() - 2), client::kWhite);
}

}  // namespace
}  // namespace affskel::experiments
