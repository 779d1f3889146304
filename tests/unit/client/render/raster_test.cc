#include "client/render/raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "client/base/error.h"
#include "client/render/image.h"
#include "client/render/panel.h"
#include "client/render/stroke_text.h"
#include "core/shapes/shapes.h"

namespace affskel::client {
namespace {

TEST(ForEachSample, TwoTrianglesCoverASquareOnce) {
  std::vector<int> hits(16 * 16, 0);
  const auto count = [&](int x, int y, double, double, double) { ++hits[std::size_t(y * 16 + x)]; };
  // The diagonal and all sides pass through sample centres.
  const ScreenPoint a{2.5, 2.5}, b{10.5, 2.5}, c{10.5, 10.5}, d{2.5, 10.5};
  for_each_sample({a, b, c}, 16, {0, 16}, count);
  for_each_sample({a, d, c}, 16, {0, 16}, count);  // the other orientation
  int total = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const bool inside = x >= 2 && x < 10 && y >= 2 && y < 10;
      EXPECT_EQ(hits[std::size_t(y * 16 + x)], inside ? 1 : 0) << x << "," << y;
      total += hits[std::size_t(y * 16 + x)];
    }
  }
  EXPECT_EQ(total, 64);
}

TEST(ForEachSample, ARandomFanCoversItsSquareOnce) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(4, 28);
  for (int round = 0; round < 50; ++round) {
    std::vector<int> hits(32 * 32, 0);
    const ScreenPoint hub{place(random), place(random)};
    const std::array<ScreenPoint, 4> corners = {{{-3, -3}, {35, -3}, {35, 35}, {-3, 35}}};
    for (std::size_t e = 0; e < 4; ++e) {
      for_each_sample({hub, corners[e], corners[(e + 1) % 4]}, 32, {0, 32},
                      [&](int x, int y, double, double, double) { ++hits[std::size_t(y * 32 + x)]; });
    }
    for (const int hit : hits) ASSERT_EQ(hit, 1);
  }
}

TEST(ForEachSample, WeightsAreBarycentric) {
  const std::array<ScreenPoint, 3> corners = {{{1, 1}, {30, 4}, {9, 28}}};
  for (const bool swapped : {false, true}) {
    std::array<ScreenPoint, 3> p = corners;
    if (swapped) std::swap(p[0], p[1]);
    int samples = 0;
    for_each_sample(p, 32, {0, 32}, [&](int x, int y, double w0, double w1, double w2) {
      ++samples;
      EXPECT_NEAR(w0 + w1 + w2, 1, 1e-12);
      EXPECT_NEAR(w0 * p[0].x + w1 * p[1].x + w2 * p[2].x, x + 0.5, 1e-9);
      EXPECT_NEAR(w0 * p[0].y + w1 * p[1].y + w2 * p[2].y, y + 0.5, 1e-9);
    });
    EXPECT_GT(samples, 300);
  }
}

TEST(ForEachSample, DrawsNothingForDegenerateOrDistantTriangles) {
  const auto fail = [](int, int, double, double, double) { FAIL(); };
  for_each_sample({{{1, 1}, {5, 5}, {9, 9}}}, 16, {0, 16}, fail);
  for_each_sample({{{100, 1}, {1e9, 5}, {120, 9}}}, 16, {0, 16}, fail);
}

constexpr View kFront{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
constexpr Rgb kRed{1, 0, 0}, kBlue{0, 0, 1};

TEST(Panel, NearerBallsHideFartherOnes) {
  for (const bool red_first : {true, false}) {
    Panel panel(20, 20, kFront, {0, 0, 0}, 1);
    const Ball near{{0, -5, 0}, kRed}, far{{0, 5, 0}, kBlue};  // the viewer is at -y
    panel.draw_ball(red_first ? near : far, 4);
    panel.draw_ball(red_first ? far : near, 4);
    const Rgb middle = panel.resolve().at(10, 10);
    EXPECT_GT(middle.r, 0.5f);
    EXPECT_EQ(middle.b, 0);
  }
}

TEST(Panel, BallsAreRoundAndInPlace) {
  Panel panel(40, 40, kFront, {0, 0, 0}, 2);
  panel.draw_ball({{5, 0, 5}, kRed}, 6);  // 10 pixels right of and above the middle
  const Image image = panel.resolve();
  double covered = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (image.at(x, y).b < 1) covered += 1 - double(image.at(x, y).b);
    }
  }
  EXPECT_NEAR(covered, 3.14159 * 36, 4);
  EXPECT_EQ(image.at(30, 10).b, 0);
  EXPECT_EQ(image.at(10, 30), kWhite);
}

TEST(Panel, AnEllipsoidOfEqualAxesIsABall) {
  Panel balls(40, 40, kFront, {0, 0, 0}, 2), ellipsoids(40, 40, kFront, {0, 0, 0}, 2);
  for (const double y : {0., 2.}) {  // the second is partly hidden
    const Ball ball{{2 + y, y, 1}, y > 0 ? kBlue : kRed};
    balls.draw_ball(ball, 6);
    ellipsoids.draw_ellipsoid(ball, {{{0, 0, 3}, {1.8, 2.4, 0}, {-2.4, 1.8, 0}}});  // radius 3, turned
  }
  const Image a = balls.resolve(), b = ellipsoids.resolve();
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      EXPECT_NEAR(a.at(x, y).r, b.at(x, y).r, 1e-5) << x << "," << y;
      EXPECT_NEAR(a.at(x, y).b, b.at(x, y).b, 1e-5) << x << "," << y;
    }
  }
}

TEST(Panel, EllipsoidsHaveTheShadowOfTheStretchedBall) {
  // The ball's image under u -> 2 u_x right + (u_x + 5 u_z) up, and 40 in depth: an ellipse of area 10 pi.
  Panel panel(40, 40, kFront, {0, 0, 0}, 2);
  const Ball red{{1, 0, 0}, kRed};
  panel.draw_ellipsoid(red, {{{2, 0, 1}, {1e-9, 40, 0}, {0, 0, 5}}});
  const Image image = panel.resolve();
  double covered = 0;
  int left = 40, right = 0, top = 40, bottom = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      if (image.at(x, y).b == 1) continue;
      covered += 1 - double(image.at(x, y).b);
      left = std::min(left, x), right = std::max(right, x + 1);
      top = std::min(top, y), bottom = std::max(bottom, y + 1);
    }
  }
  EXPECT_NEAR(covered, 3.14159 * 10 * 4, 5);
  EXPECT_NEAR(left, 22 - 4, 1);
  EXPECT_NEAR(right, 22 + 4, 1);
  EXPECT_NEAR(top, 20 - 2 * std::sqrt(26), 1);
  EXPECT_NEAR(bottom, 20 + 2 * std::sqrt(26), 1);
  // Its depth counts: it reaches 40 towards the viewer.
  panel.draw_ball({{1, -30, 0}, kBlue}, 3);
  EXPECT_EQ(panel.resolve().at(22, 20).b, 0);
  panel.draw_ball({{1, -50, 0}, kBlue}, 3);
  EXPECT_EQ(panel.resolve().at(22, 20).r, 0);
}

TEST(Panel, FlatEllipsoidsAreNotDrawn) {
  Panel panel(20, 20, kFront, {0, 0, 0}, 1);
  panel.draw_ellipsoid({{0, 0, 0}, kRed}, {{{5, 0, 0}, {0, 0, 5}, {5, 0, 5}}});
  EXPECT_EQ(panel.resolve().at(10, 10), kWhite);
}

TEST(Panel, TheSurfaceVeilsOnlyWhatIsBehindIt) {
  // A square in the plane y = 0, seen from -y.
  const core::Mesh square{{{-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}}, {{0, 1, 2}, {0, 2, 3}}};
  const auto middle = [&](double ball_y) {
    Panel panel(20, 20, kFront, {0, 0, 0}, 1);
    panel.draw_ball({{0, ball_y, 0}, kRed}, 3);
    panel.draw_surface(square, corner_normals(square));
    return panel.resolve().at(10, 10);
  };
  EXPECT_EQ(middle(-5).b, 0) << "a ball in front keeps its colour";
  EXPECT_GT(middle(5).b, 0.02f) << "a ball behind shines through a veil";
  EXPECT_GT(middle(5).r, 0.5f);
}

TEST(Panel, SheetsAreOpaqueFromEitherSideAndHideWhatIsBehind) {
  // A square in the plane y = 0, seen from -y, in either orientation.
  for (const bool turned : {false, true}) {
    const core::Triangle one = turned ? core::Triangle{0, 2, 1} : core::Triangle{0, 1, 2};
    const core::Triangle two = turned ? core::Triangle{0, 3, 2} : core::Triangle{0, 2, 3};
    const core::Mesh square{{{-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}}, {one, two}};
    const auto middle = [&](double ball_y) {
      Panel panel(20, 20, kFront, {0, 0, 0}, 1);
      panel.draw_ball({{0, ball_y, 0}, kRed}, 3);
      panel.draw_sheet(square, {kBlue, kBlue, kBlue, kBlue});
      return panel.resolve().at(10, 10);
    };
    EXPECT_EQ(middle(5).r, 0) << "a ball behind is hidden";
    EXPECT_GT(middle(5).b, 0.7f) << "a facet that faces the viewer is bright";
    EXPECT_EQ(middle(-5).b, 0) << "a ball in front hides the facet";
  }
}

// A square of side 16 in a plane that holds the x axis and rises to `up` there, red on the left, blue on the
// right.
Image picture_of_sheet(const core::Vec3& up) {
  const core::Vec3 left{-8, 0, 0}, right{8, 0, 0};
  const core::Mesh square{{left - 8 * up, right - 8 * up, right + 8 * up, left + 8 * up},
                          {{0, 1, 2}, {0, 2, 3}}};
  Panel panel(20, 20, kFront, {0, 0, 0}, 1);
  panel.draw_sheet(square, {kRed, kBlue, kBlue, kRed});
  return panel.resolve();
}

TEST(Panel, SheetsBlendTheColoursOfTheirVertices) {
  const Image image = picture_of_sheet({0, 0, 1});
  for (int y = 3; y < 17; ++y) {
    const float sum = image.at(3, y).r + image.at(3, y).b;  // the light
    EXPECT_GT(sum, 0.7f);
    for (int x = 3; x < 17; ++x) {
      const float share = static_cast<float>(x + 0.5 - 2) / 16;
      EXPECT_NEAR(image.at(x, y).b, sum * share, 0.02) << x << "," << y;
      EXPECT_NEAR(image.at(x, y).r, sum * (1 - share), 0.02) << x << "," << y;
    }
  }
  EXPECT_EQ(image.at(1, 10), kWhite);
}

TEST(Panel, ASheetSeenFromItsEdgeIsALineOfAPixel) {
  for (const core::Vec3& up : {core::Vec3{0, 1, 0}, core::Vec3{0, 1, 0.01}}) {
    const Image image = picture_of_sheet(up);
    for (int x = 3; x < 17; ++x) {
      float covered = 0;
      for (int y = 0; y < 20; ++y) covered += 1 - image.at(x, y).g;
      EXPECT_NEAR(covered, 1, 0.51) << x;
    }
    EXPECT_GT(image.at(4, 10).r + image.at(4, 9).r, image.at(4, 10).b + image.at(4, 9).b);
  }
}

TEST(Panel, CurvesHaveNoBeads) {
  const std::vector<core::Vec3> points = {{-8, 0, 0}, {-2, 0, 0}, {3, 0, 0}, {8, 0, 0}};
  Panel panel(20, 20, kFront, {0, 0, 0}, 1);
  panel.draw_curves(points, {{0, 1}, {1, 2}, {2, 3}}, std::vector<Rgb>(4, kBlue), 4);
  const Image image = panel.resolve();
  for (int x = 4; x < 16; ++x) {
    for (int y = 9; y < 11; ++y) EXPECT_NEAR(image.at(x, y).b, image.at(10, 10).b, 1e-6) << x << "," << y;
  }
}

// A flat sheet with a band of slivers, each thinner than a pixel, between wide strips.
TEST(Panel, SliversLeaveNoSpecksInASheet) {
  core::Mesh sheet;
  std::vector<double> heights = {-8};
  for (int r = 0; r <= 20; ++r) heights.push_back(-0.5 + 0.05 * r);
  heights.push_back(8);
  const auto rows = static_cast<unsigned>(heights.size() - 1);
  for (const double z : heights) {
    for (const double x : {-8., 8.}) sheet.points.push_back({x, 0, z});
  }
  for (unsigned r = 0; r < rows; ++r) {
    sheet.triangles.push_back({2 * r, 2 * r + 1, 2 * r + 2});
    sheet.triangles.push_back({2 * r + 1, 2 * r + 3, 2 * r + 2});
  }
  // Turned from the light, so that a line of another light would show.
  const View view{{0.8, -0.6, 0}, {0, 0, 1}, {-0.6, -0.8, 0}};
  Panel panel(20, 20, view, {0, 0, 0}, 1);
  panel.draw_sheet(sheet, std::vector<Rgb>(sheet.points.size(), kBlue));
  const Image image = panel.resolve();
  const Rgb middle = image.at(10, 6);  // of a wide strip
  EXPECT_LT(middle.b, 0.85f);
  for (int y = 4; y < 16; ++y) {
    for (int x = 6; x < 14; ++x) EXPECT_NEAR(image.at(x, y).b, middle.b, 1e-6) << x << "," << y;
  }
}

TEST(Panel, CurvesAreLinesOfTheirWidthSeenFromAnySide) {
  const std::vector<core::Vec3> points = {{-8, 0, 0}, {8, 0, 0}};
  for (const double width : {2.0, 4.0}) {
    Panel panel(20, 20, kFront, {0, 0, 0}, 1);
    panel.draw_curves(points, {{0, 1}}, {kRed, kBlue}, width);
    const Image image = panel.resolve();
    for (int x = 3; x < 17; ++x) {
      float covered = 0;
      for (int y = 0; y < 20; ++y) covered += 1 - image.at(x, y).g;
      EXPECT_NEAR(covered, width, 0.51) << x;
    }
    EXPECT_GT(image.at(4, 10).r, image.at(4, 10).b);
    EXPECT_GT(image.at(15, 10).b, image.at(15, 10).r);
    // From its end it is a dot.
    Panel from_end(20, 20, {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, {0, 0, 0}, 1);
    from_end.draw_curves(points, {{0, 1}}, {kRed, kBlue}, width);
    EXPECT_LT(from_end.resolve().at(10, 10).g, 0.3f);
  }
}

TEST(Panel, BandsMakeTheWholePicture) {
  const core::Mesh ball = core::make_sphere(60, 320);
  const std::vector<core::Vec3> normals = corner_normals(ball);
  const std::vector<Rgb> colours(ball.triangles.size(), kBlue);
  const auto draw = [&](Panel& panel) {
    panel.draw_ball({{20, 0, 10}, kRed}, 40);
    panel.draw_ellipsoid({{-20, 5, 0}, kBlue}, {{{30, 0, 10}, {0, 20, 0}, {0, 0, 70}}});
    panel.draw_curves({{-80, -70, -150}, {80, -70, 150}}, {{0, 1}}, {kRed, kBlue}, 3);
    panel.draw_surface(ball, normals);
    panel.draw_shell(ball, normals, colours, 0.3f);
  };
  constexpr int kWidth = 200, kHeight = 401;
  Panel whole(kWidth, kHeight, kFront, {0, 0, 0}, 1);
  draw(whole);
  const Image expected = whole.resolve();
  Panel panel = Panel::banded(kWidth, kHeight, kFront, {0, 0, 0}, 1);
  int rows = 0, bands = 0;
  do {
    draw(panel);
    const Image band = panel.resolve();
    ASSERT_EQ(panel.top(), rows);
    for (int y = 0; y < band.height(); ++y) {
      for (int x = 0; x < kWidth; ++x) ASSERT_EQ(band.at(x, y), expected.at(x, rows + y)) << x << "," << y;
    }
    rows += band.height();
    ++bands;
  } while (panel.next_band());
  EXPECT_EQ(rows, kHeight);
  EXPECT_EQ(bands, 3);
}

TEST(Panel, SurfaceLayersDoNotDependOnTheirOrder) {
  core::Mesh two{{{-9, 0, -9}, {9, 0, -9}, {0, 0, 9}, {-9, 3, -9}, {9, 6, -9}, {0, 1, 9}},
                 {{0, 1, 2}, {3, 4, 5}}};
  const auto picture = [&] {
    Panel panel(20, 20, kFront, {0, 0, 0}, 1);
    panel.draw_surface(two, corner_normals(two));
    return panel.resolve().at(10, 12);
  };
  const Rgb one_way = picture();
  std::swap(two.triangles[0], two.triangles[1]);
  const Rgb other_way = picture();
  EXPECT_NEAR(one_way.r, other_way.r, 1e-6);
  EXPECT_NEAR(one_way.b, other_way.b, 1e-6);
  EXPECT_LT(one_way.r, 1);
}

TEST(CornerNormals, KeepEdgesAndSmoothBends) {
  const core::Mesh box = core::make_box(1, 1, 1);
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto& corners = box.triangles[t];
    const core::Vec3 flat = core::cross(box.points[corners[1]] - box.points[corners[0]],
                                        box.points[corners[2]] - box.points[corners[0]]);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(core::dot(corner_normals(box)[3 * t + c], flat), core::norm(flat), 1e-12);
  }
  const core::Mesh ball = core::make_sphere(1, 320);
  const std::vector<core::Vec3> normals = corner_normals(ball);
  for (std::size_t h = 0; h < normals.size(); ++h) {
    EXPECT_GT(core::dot(normals[h], ball.points[ball.triangles[h / 3][h % 3]]), 0.98);
  }
}

// Black pixels of a text.
int ink_of(const std::string& text) {
  Image image(60, 60);
  draw_text(image, {15, 40}, text, 18, {0, 0, 0});
  int dark = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) dark += image.at(x, y).r < 0.5f ? 1 : 0;
  return dark;
}

TEST(Text, MarksAreDrawnAndTakeNoWidth) {
  for (const char* letter :
       {"\u00E9", "\u00E0", "\u00EA", "\u00EB", "\u0113", "\u0115", "\u0117", "\u0119", "\u011B"}) {
    EXPECT_GT(ink_of(letter), ink_of("e") + 3) << letter;
    EXPECT_EQ(text_width(letter, 12), text_width("e", 12)) << letter;
  }
  for (const char* letter : {"\u00F5", "\u0151", "\u00F8"})
    EXPECT_GT(ink_of(letter), ink_of("o") + 3) << letter;
  EXPECT_GT(ink_of("\u00E5"), ink_of("a") + 3);
  EXPECT_LT(ink_of("\u0131"), ink_of("i")) << "without its dot";
  EXPECT_EQ(text_width("\u5F62", 12), text_width("\u0416", 12)) << "a box for each character";
}

TEST(Text, LettersLeaveInkAndTakeWidth) {
  const std::string all = [] {
    std::string text;
    for (char c = '!'; c <= '~'; ++c) text += c;
    return text;
  }();
  for (const char c : all) {
    Image image(40, 40);
    draw_text(image, {10, 25}, std::string(1, c), 12, {0, 0, 0});
    int dark = 0;
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) dark += image.at(x, y).r < 0.5f ? 1 : 0;
    }
    EXPECT_GT(dark, 0) << c;
  }
  EXPECT_GT(text_width("12", 12), text_width("1", 12));
  EXPECT_NEAR(text_width("0", 24), 2 * text_width("0", 12), 1e-9);
}

TEST(Viridis, RunsFromVioletToYellow) {
  EXPECT_NEAR(viridis(0).r, 68 / 255.0, 1e-6);
  EXPECT_NEAR(viridis(1).g, 231 / 255.0, 1e-6);
  EXPECT_EQ(viridis(-3), viridis(0));
  EXPECT_EQ(viridis(7), viridis(1));
}

}  // namespace
}  // namespace affskel::client
