#include "client/render/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "client/base/error.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "sample_data.h"

namespace affskel::client {
namespace {

TEST(RenderScene, IsAPngOfTheWidthAskedFor) {
  RenderInput input;
  input.mesh = core::make_sphere(100, 80);
  input.skeleton = sample_skeleton();
  input.cell = {{{10, 0, 0}, {0, 10, 0}, {0, 0, 10}}};
  input.volume = 4e6;
  input.title = "ball";
  const Image image = render_scene(input, {.width = 400});
  EXPECT_EQ(image.width(), 400);
  EXPECT_GT(image.height(), 100);
  const std::string png = encode_png(image);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_THROW(render_scene(input, {.width = 10}), ClientError);
  input.mesh = {};
  EXPECT_THROW(render_scene(input, {.width = 400}), ClientError);
}

TEST(RenderScene, ASheetIsColouredByItsErosion) {
  RenderInput input;
  input.mesh = core::make_box(100, 100, 100);
  input.cell = {{{10, 0, 0}, {0, 10, 0}, {0, 0, 10}}};
  for (const double c : {10., 10., 50., 90., 10., 50., 90., 90., 50.}) input.sheet.add_xyz(c);
  for (const unsigned v : {0u, 1u, 2u}) input.sheet.add_corners(v);
  for (const double e : {5., 5., 5.}) input.sheet.add_erosion(e);  // the highest: yellow
  RenderOptions options;
  options.cameras = {parse_camera("top")};
  const auto yellow_pixels = [&] {
    const Image image = render_scene(input, options);
    int yellow = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const Rgb c = image.at(x, y);
        yellow += c.r > 0.75f && c.g > 0.7f && c.b < 0.45f ? 1 : 0;
      }
    }
    return yellow;
  };
  const int with = yellow_pixels();
  options.mesh = false;
  EXPECT_NEAR(yellow_pixels(), with, 0.02 * with) << "the glass hardly covers it";
  // Half of a square whose side is 0.8 of the box's: the same by the scale bar and by a second picture that
  // draws the other half, too.
  for (const double c : {10., 90., 50.}) input.sheet.add_xyz(c);
  for (const unsigned v : {0u, 2u, 3u}) input.sheet.add_corners(v);
  input.sheet.add_erosion(5);
  EXPECT_NEAR(yellow_pixels(), 2 * with, 0.03 * with);
}

TEST(RenderScene, AVertexAloneIsASpot) {
  RenderInput input;
  input.mesh = core::make_box(100, 100, 100);
  input.cell = {{{10, 0, 0}, {0, 10, 0}, {0, 0, 10}}};
  RenderOptions options;
  options.cameras = {parse_camera("top")};
  options.bare = true;  // the legend would make the picture higher
  const Image without = render_scene(input, options);
  for (int k = 0; k < 3; ++k) input.sheet.add_xyz(50);
  input.sheet.add_erosion(5);
  const Image with = render_scene(input, options);
  ASSERT_EQ(with.height(), without.height());
  int changed = 0;
  for (int y = 0; y < with.height(); ++y)
    for (int x = 0; x < with.width(); ++x) changed += with.at(x, y) == without.at(x, y) ? 0 : 1;
  EXPECT_GT(changed, 10);
}

TEST(RenderScene, ASmallPictureShowsNeitherEdgesNorEnds) {
  const std::vector<std::pair<core::Mesh, const char*>> expected = {
      {core::make_box(100, 60, 4), "top"},    {core::make_box(4, 100, 60), "side"},
      {core::make_box(5, 100, 5), "side"},    {core::make_box(100, 4, 60), "front"},
      {core::make_box(50, 100, 70), "front"}, {core::make_body(), "front"}};
  for (const auto& [mesh, camera] : expected) {
    RenderInput input;
    input.mesh = mesh;
    input.cell = {{{10, 0, 0}, {0, 10, 0}, {0, 0, 10}}};
    RenderOptions options{.width = 200, .bare = true};
    const std::string chosen = encode_png(render_scene(input, options));
    options.cameras = {parse_camera(camera)};
    EXPECT_EQ(chosen, encode_png(render_scene(input, options))) << camera;
  }
}

// Two halves of a bar, one above the other: from the front both are named, from above the one that hides the other.
TEST(RenderScene, NamesThePartsThatAreSeen) {
  RenderInput input;
  input.mesh = core::make_box(100, 100, 50);
  const auto half = input.mesh.points.size();
  const core::Mesh upper = input.mesh;
  for (const core::Vec3& p : upper.points) input.mesh.points.push_back(p + core::Vec3{0, 0, 50});
  for (const auto& [a, b, c] : upper.triangles) {
    const auto by = static_cast<std::uint32_t>(half);
    input.mesh.triangles.push_back({a + by, b + by, c + by});
  }
  input.cell = {{{10, 0, 0}, {0, 10, 0}, {0, 0, 10}}};
  const Rgb low{0.8f, 0.8f, 0.4f}, high{0.5f, 0.8f, 0.9f};
  input.painted.emplace();
  input.painted->mesh = input.mesh;
  for (std::size_t t = 0; t < input.mesh.triangles.size(); ++t)
    input.painted->colours.push_back(2 * t < input.mesh.triangles.size() ? low : high);
  const Label lower_label{{50, 50, 25}, "8", low}, upper_label{{50, 50, 75}, "8", high};
  const auto dark_pixels = [&](const char* camera, const std::vector<Label>& labels) {
    RenderOptions options;
    options.cameras = {parse_camera(camera)};
    input.painted->labels = labels;
    const Image image = render_scene(input, options);
    int dark = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) dark += image.at(x, y).g < 0.3f ? 1 : 0;
    return dark;
  };
  for (const char* camera : {"front", "top"}) {
    const int none = dark_pixels(camera, {});
    const int one = dark_pixels(camera, {upper_label}) - none;
    EXPECT_GT(one, 10) << camera;
    const bool front = camera == std::string("front");
    EXPECT_EQ(dark_pixels(camera, {lower_label}) - none > 10, front) << camera;
    EXPECT_EQ(dark_pixels(camera, {upper_label, upper_label}) - none, one) << "one has room";
  }
}

TEST(RenderScene, LabelsAreReadOnDarkPartsAndBackgrounds) {
  RenderInput input;
  input.mesh = core::make_box(100, 100, 100);
  input.cell = {{{10, 0, 0}, {0, 10, 0}, {0, 0, 10}}};
  input.painted.emplace();
  input.painted->mesh = input.mesh;
  const Rgb dark{0.1f, 0, 0.1f};
  input.painted->colours.assign(input.mesh.triangles.size(), dark);
  RenderOptions options;
  options.background = {0, 0, 0};
  options.cameras = {parse_camera("front")};
  const auto light = [&] {
    const Image image = render_scene(input, options);
    int count = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) count += image.at(x, y).g > 0.99f ? 1 : 0;
    return count;
  };
  const int none = light();
  input.painted->labels = {{{50, 50, 50}, "8", dark}};
  EXPECT_GT(light() - none, 20) << "round its strokes";
}

// The largest rectangle of one colour, as a share of the picture.
double largest_empty_share(const Image& image, Rgb background) {
  std::vector<int> above(std::size_t(image.width()) + 1, 0);  // empty pixels above and at a place of the row
  std::size_t largest = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      int& run = above[std::size_t(x)];
      run = image.at(x, y) == background ? run + 1 : 0;
    }
    std::vector<std::size_t> rising;
    for (std::size_t x = 0; x < above.size(); ++x) {
      while (!rising.empty() && above[rising.back()] >= above[x]) {
        const auto height = std::size_t(above[rising.back()]);
        rising.pop_back();
        largest = std::max(largest, height * (rising.empty() ? x : x - rising.back() - 1));
      }
      rising.push_back(x);
    }
  }
  return double(largest) / (double(image.width()) * image.height());
}

RenderInput sample_scene(const core::Mesh& mesh) {
  RenderInput input;
  input.mesh = mesh;
  input.skeleton = sample_skeleton();
  input.cell = {{{10, 0, 0}, {0, 10, 0}, {0, 0, 10}}};
  input.volume = 4e6;
  input.title = "sample";
  return input;
}

TEST(RenderScene, NoThirdOfThePictureIsEmpty) {
  const auto stretched = [](core::Mesh mesh, double x, double y, double z) {
    for (core::Vec3& p : mesh.points) p = {x * p.x, y * p.y, z * p.z};
    return mesh;
  };
  const core::Mesh body = core::make_body();
  const std::vector<core::Mesh> meshes = {body,
                                          stretched(body, 2, 1, 1),
                                          stretched(body, 2, 0.5, 1),
                                          core::make_box(1, 1, 1),
                                          core::make_box(12, 12, 4),
                                          core::make_box(1, 4, 1),
                                          core::make_box(6, 1, 1)};
  for (const core::Mesh& mesh : meshes) {
    const RenderInput input = sample_scene(mesh);
    EXPECT_LT(largest_empty_share(render_scene(input, {.width = 800}), kWhite), 0.25);
  }
}

TEST(RenderScene, DefectsAreMarkedHoweverSmall) {
  RenderInput input;
  input.mesh = core::make_sphere(100, 1280);
  input.cell = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  constexpr Rgb kMark{1, 0, 0};
  const auto marked = [&](const RenderInput& scene) {
    const Image image =
        render_scene(scene, {.width = 600, .cameras = {parse_camera("front"), parse_camera("back")}});
    std::size_t red = 0;
    for (int y = 0; y < image.height() * 2 / 3; ++y)
      for (int x = 0; x < image.width(); ++x) {
        const Rgb c = image.at(x, y);
        red += c.r > 0.45f && c.r > 2 * c.g && c.r > 2 * c.b ? 1 : 0;
      }
    return red;
  };
  EXPECT_EQ(marked(input), 0u);
  const core::Triangle& t = input.mesh.triangles[0];
  input.marks = {{{kMark, "1 open edge"}, {{t[0], t[1]}}}};
  EXPECT_GT(marked(input), 8u);
}

TEST(RenderScene, UpIsUp) {
  // A pyramid along x: from the front its tip must be at the top of what is drawn, whichever axis is up.
  RenderInput input = sample_scene(
      {{{0, 0, 0}, {0, 40, 0}, {0, 0, 40}, {120, 10, 10}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}});
  input.skeleton.Clear();
  input.title.clear();
  RenderOptions options;
  options.cameras = {{"", 0, 0}};
  constexpr core::Stance kX{{0, false}, {2, false}};
  const auto shape_of = [&](const core::Stance& stance) {
    input.stance = stance;
    const Image image = render_scene(input, options);
    std::vector<int> rows;  // dark pixels per row, of the drawing
    for (int y = 0; y < image.height(); ++y) {
      int drawn = 0;
      for (int x = 0; x < image.width(); ++x) drawn += image.at(x, y) == kWhite ? 0 : 1;
      rows.push_back(drawn);
    }
    return rows;
  };
  const std::vector<int> rows = shape_of(kX);
  const auto first = std::find_if(rows.begin(), rows.end(), [](int drawn) { return drawn > 0; });
  ASSERT_NE(first, rows.end());
  EXPECT_LT(*(first + 10), *(first + 300)) << "the tip is above";
  EXPECT_NE(shape_of(kX), shape_of({}));
}

TEST(RenderScene, LeavesOutTheMeshAndDrawsTheErodedSolid) {
  RenderInput input = sample_scene(core::make_sphere(100, 320));
  input.skeleton.Clear();
  RenderOptions options;
  options.width = 400;
  const auto orange = [&] {
    const Image image = render_scene(input, options);
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) count += image.at(x, y).r > image.at(x, y).b + 0.1f ? 1 : 0;
    }
    return count;
  };
  const Image with = render_scene(input, options);
  options.mesh = false;
  const Image without = render_scene(input, options);
  EXPECT_EQ(with.height(), without.height()) << "the same view";
  EXPECT_GT(largest_empty_share(without, kWhite), 1.5 * largest_empty_share(with, kWhite));
  EXPECT_EQ(orange(), 0);
  const core::Mesh ball = core::make_sphere(50, 320);
  for (const core::Vec3& p : ball.points) {
    for (const double c : {p.x, p.y, p.z}) input.eroded.add_xyz(c);
  }
  for (const core::Triangle& t : ball.triangles) {
    for (const std::uint32_t v : t) input.eroded.add_corners(v);
  }
  input.level = "eroded solid";
  EXPECT_GT(orange(), 1000);
}

TEST(RenderScene, InkIsReadOnEveryBackground) {
  for (const char* name : {"white", "black", "dark", "#fff", "#1b2a3C", "#808080"}) {
    RenderOptions options;
    options.background = parse_background(name);
    const Image image = render_scene(sample_scene(core::make_sphere(100, 80)), options);
    EXPECT_EQ(image.at(2, 2), options.background) << name;
    float most = 0;
    for (int y = 0; y < image.height() / 20; ++y) {  // the title
      for (int x = 0; x < image.width(); ++x)
        most = std::max(most, std::fabs(image.at(x, y).g - options.background.g));
    }
    EXPECT_GT(most, 0.35f) << name;
  }
  EXPECT_EQ(parse_background("#f80"), (Rgb{1, 136 / 255.0f, 0}));
  for (const char* name : {"", "red", "#12", "#12345", "#gggggg", "ffffff"})
    EXPECT_THROW(parse_background(name), ClientError) << name;
}

// How many pixels a point without erosion makes dark, in all three views.
int pixels_of_a_point(const std::array<core::Vec3, 3>& cell) {
  RenderInput input;
  input.mesh = core::make_sphere(100, 80);
  input.cell = cell;
  const Image without = render_scene(input);
  for (const double c : {0., 0., 0.}) input.skeleton.add_xyz(c);
  input.skeleton.add_point(0);
  input.skeleton.add_erosion(0);
  const Image with = render_scene(input);
  int count = 0;
  for (int y = 0; y < with.height(); ++y) {
    for (int x = 0; x < with.width(); ++x) {
      count += with.at(x, y).g < 0.5f && without.at(x, y).g > 0.5f ? 1 : 0;
    }
  }
  return count;
}

TEST(RenderScene, PointsAreAsLargeAsTheirCells) {
  const int cube = pixels_of_a_point({{{12, 0, 0}, {0, 12, 0}, {0, 0, 12}}});
  // The same volume: from the front and from the side twice as large, from above a quarter.
  const int tall = pixels_of_a_point({{{6, 0, 0}, {0, 6, 0}, {0, 0, 48}}});
  EXPECT_GT(cube, 50);
  EXPECT_NEAR(double(tall) / cube, (2 + 2 + 0.25) / 3, 0.1);
}

}  // namespace
}  // namespace affskel::client
