#include "client/view/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "client/base/error.h"
#include "core/shapes/shapes.h"

namespace affskel::client {
namespace {

using nlohmann::json;

// A box of 2 x 4 x 10 whose two points lie at its corner and at its centre.
ViewModel sample_model() {
  ViewModel input;
  input.job.set_name("box");
  input.job.set_id("0123456789abcdef0123456789abcdef");
  input.job.mutable_prepared()->set_volume(80);
  input.job.mutable_prepared()->set_spacing(1);
  input.job.mutable_prepared()->set_points(2);
  input.mesh = core::make_box(2, 4, 10);
  input.operator_name = "zucker-hummel";
  input.threshold = 7;
  input.grid.axes = {{{1, 0, 0}, {0, 2, 0}, {0, 0, 5}}};
  input.grid.lattice_steps = {1, 1, 1};
  ViewPoint centre, corner;
  centre.step = {1, 1, 1};
  centre.share = 0.5f;
  centre.divergence = 9;
  centre.slope = 3.5f;
  centre.inward = {0, 0, -1};
  corner.divergence = 1;
  corner.inward = {1, 0, 0};
  input.points = {centre, corner};
  return input;
}

// A surface in its middle, at one level.
v1::TriangleMesh sample_eroded() {
  v1::TriangleMesh surface;
  for (const double v : {0., 0., 0., 2., 4., 10., 1., 2., 5.}) surface.add_xyz(v);
  for (const unsigned c : {0u, 1u, 2u}) surface.add_corners(c);
  for (const double a : {3., 4., 5.}) surface.add_area(a);
  surface.set_volume(12);
  return surface;
}

ViewInput page_of(const ViewModel& model) {
  ViewInput input;
  input.models = {model};
  return input;
}

ViewInput sample_input() {
  return page_of(sample_model());
}

std::string element(const std::string& page, const std::string& id) {
  const std::string open = "id=\"" + id + "\">";
  const std::size_t begin = page.find(open) + open.size();
  return page.substr(begin, page.find("</script>", begin) - begin);
}

json page_facts(const std::string& page) {
  return json::parse(element(page, "facts"));
}

// Of its first model, with the page's own.
json facts(const std::string& page) {
  json all = page_facts(page);
  all.update(json(all.at("models").at(0)));
  return all;
}

std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 255);
  }
  return bytes;
}

template <typename Number>
std::vector<Number> array_of(const std::string& page, const char* name, const char* type) {
  const json entry = facts(page).at("arrays").at(name);
  EXPECT_EQ(entry.at(0), type) << name;
  EXPECT_EQ(entry.at(1).get<std::size_t>() % 4, 0u) << name;
  std::vector<Number> values(entry.at(2).get<std::size_t>());
  const std::string bytes = decoded(element(page, "arrays"));
  const std::size_t offset = entry.at(1).get<std::size_t>();
  EXPECT_LE(offset + values.size() * sizeof(Number), bytes.size());
  std::memcpy(values.data(), bytes.data() + offset, values.size() * sizeof(Number));
  return values;
}

// The position of a lattice place, computed as decode.js does.
std::array<double, 3> place(const json& grid, const std::vector<std::uint16_t>& steps, std::size_t point) {
  std::array<double, 3> at{};
  for (std::size_t c = 0; c < 3; ++c) {
    at[c] = grid.at("origin").at(c);
    for (std::size_t a = 0; a < 3; ++a) {
      at[c] += steps[3 * point + a] * grid.at("axes").at(a).at(c).get<double>();
    }
  }
  return at;
}

TEST(Page, PointsComeBackInPageUnits) {
  const std::string page = view_page(sample_input());
  const json all = facts(page);
  const auto steps = array_of<std::uint16_t>(page, "pointSteps", "u16");
  EXPECT_EQ(place(all.at("pointGrid"), steps, 0), (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(place(all.at("pointGrid"), steps, 1), (std::array<double, 3>{-0.2, -0.4, -1}));
  EXPECT_EQ(array_of<float>(page, "pointShares", "f32"), (std::vector<float>{0.5f, 0}));
  EXPECT_EQ(array_of<float>(page, "pointDivergences", "f32"), (std::vector<float>{9, 1}));
  EXPECT_EQ(array_of<float>(page, "pointSlopes", "f32"), (std::vector<float>{3.5f, 0}));
  EXPECT_EQ(array_of<std::int8_t>(page, "pointInward", "i8"),
            (std::vector<std::int8_t>{0, 0, -127, 127, 0, 0}));
  EXPECT_EQ(all.at("highestShare"), 0.5);
  EXPECT_EQ(all.at("unit"), 5);
  EXPECT_EQ(all.at("centre"), json({1, 2, 5}));
  EXPECT_EQ(all.at("box"), json({2, 4, 10}));
}

TEST(Page, TheCellIsTheLatticesAlsoWhereTheGridIsCoarser) {
  ViewModel input = sample_model();
  input.grid.axes = {{{1, 0.5, 0}, {0, 2, 0}, {0, 0, 5}}};
  input.grid.lattice_steps = {1, 2, 1};
  EXPECT_EQ(facts(view_page(page_of(input))).at("cell"), json({{0.2, 0.1, 0}, {0, 0.2, 0}, {0, 0, 1}}));
}

TEST(Page, TheMeshComesBack) {
  const ViewModel input = sample_model();
  const std::string page = view_page(page_of(input));
  const auto steps = array_of<std::uint16_t>(page, "meshSteps", "u16");
  ASSERT_EQ(steps.size(), 3 * input.mesh.points.size());
  for (std::size_t v = 0; v < input.mesh.points.size(); ++v) {
    const core::Vec3 expected = 0.2 * (input.mesh.points[v] - core::Vec3{1, 2, 5});
    const std::array<double, 3> at = place(facts(page).at("meshGrid"), steps, v);
    EXPECT_NEAR(at[0], expected.x, 1e-5);
    EXPECT_NEAR(at[1], expected.y, 1e-5);
    EXPECT_NEAR(at[2], expected.z, 1e-5);
  }
  const auto corners = array_of<std::uint16_t>(page, "meshCorners", "u16");
  ASSERT_EQ(corners.size(), 3 * input.mesh.triangles.size());
  for (std::size_t c = 0; c < corners.size(); ++c) {
    EXPECT_EQ(corners[c], input.mesh.triangles[c / 3][c % 3]);
  }
}

TEST(Page, TheSheetOfChordsComesBack) {
  ViewModel input = sample_model();
  EXPECT_FALSE(facts(view_page(page_of(input))).at("arrays").contains("sheetCorners"));
  input.sheet_is_skeleton = true;
  for (const double v : {1., 2., 5., 2., 2., 5., 0., 0., 0.}) input.sheet.add_xyz(v);
  for (const unsigned c : {2u, 0u, 1u}) input.sheet.add_corners(c);
  for (const double e : {40., 20., 10.}) input.sheet.add_erosion(e);
  for (const double s : {1., 0.75, 0.5}) input.sheet.add_strength(s);
  for (const double a : {6., 7., 8.}) input.sheet.add_area(a);
  for (const unsigned kind : {0u, 2u, 3u}) input.sheet.add_kind(kind);
  for (const double c : {1., 0., 0., 0., 1., 0., 0., 0., -1.}) input.sheet.add_normal_a(c);
  const std::string page = view_page(page_of(input));
  EXPECT_EQ(array_of<float>(page, "sheetSlopes", "f32"), (std::vector<float>{6, 7, 8}));
  EXPECT_EQ(array_of<std::int8_t>(page, "sheetKinds", "i8"), (std::vector<std::int8_t>{0, 2, 3}));
  EXPECT_EQ(array_of<float>(page, "sheetStrengths", "f32"), (std::vector<float>{1, 0.75f, 0.5f}));
  EXPECT_EQ(array_of<std::int8_t>(page, "sheetNormalsA", "i8"),
            (std::vector<std::int8_t>{127, 0, 0, 0, 127, 0, 0, 0, -127}));
  EXPECT_TRUE(array_of<std::int8_t>(page, "sheetNormalsB", "i8").empty());
  EXPECT_EQ(array_of<float>(page, "sheetPositions", "f32"),
            (std::vector<float>{0, 0, 0, 0.2f, 0, 0, -0.2f, -0.4f, -1}));
  EXPECT_EQ(array_of<float>(page, "sheetShares", "f32"), (std::vector<float>{0.5f, 0.25f, 0.125f}));
  EXPECT_EQ(array_of<std::uint32_t>(page, "sheetPieces", "u32"), (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(array_of<float>(page, "sheetPieceShares", "f32"), (std::vector<float>{1}));
  EXPECT_EQ(array_of<std::uint32_t>(page, "sheetCorners", "u32"), (std::vector<std::uint32_t>{2, 0, 1}));
  EXPECT_TRUE(array_of<std::uint32_t>(page, "sheetSegments", "u32").empty());
  for (const unsigned v : {1u, 2u}) input.sheet.add_segments(v);
  const std::string with_curve = view_page(page_of(input));
  EXPECT_EQ(array_of<std::uint32_t>(with_curve, "sheetSegments", "u32"), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(array_of<std::uint32_t>(with_curve, "sheetPieces", "u32"), (std::vector<std::uint32_t>{0, 0}));
  input.sheet.clear_corners();
  input.sheet.clear_segments();
  const std::string points = view_page(page_of(input));
  EXPECT_EQ(array_of<std::uint32_t>(points, "sheetSegments", "u32"),
            (std::vector<std::uint32_t>{0, 0, 1, 1, 2, 2}))
      << "spots";
}

TEST(Page, TheErodedSolidsComeBackWithTheirLevels) {
  ViewModel model = sample_model();
  model.eroded = {sample_eroded()};
  ViewInput input = page_of(model);
  input.levels = {0.25};
  input.show_level = true;
  const std::string page = view_page(input);
  const json all = facts(page);
  EXPECT_EQ(all.at("levels"), json({0.25}));
  EXPECT_EQ(all.at("showLevel"), true);
  EXPECT_EQ(all.at("eroded"), json::array({{{"volume", 12.0}, {"triangles", 1}}}));
  const auto steps = array_of<std::uint16_t>(page, "eroded0Steps", "u16");
  const std::array<double, 3> low = place(all.at("meshGrid"), steps, 0),
                              middle = place(all.at("meshGrid"), steps, 2);
  EXPECT_NEAR(low[2], -1, 1e-5);
  EXPECT_NEAR(middle[0], 0, 1e-5);
  EXPECT_NEAR(middle[2], 0, 2e-5);
  EXPECT_EQ(array_of<std::uint16_t>(page, "eroded0Corners", "u16"), (std::vector<std::uint16_t>{0, 1, 2}));
  EXPECT_EQ(array_of<float>(page, "eroded0Slopes", "f32"), (std::vector<float>{3, 4, 5}));
}

TEST(Page, TwoModelsHaveOneScaleAndOneScaleOfColours) {
  ViewModel half = sample_model(), whole = sample_model();
  half.mesh = core::make_box(1, 2, 5);
  half.points[0].share = 0.25f;
  ViewInput input;
  input.models = {half, whole};
  const json all = page_facts(view_page(input));
  ASSERT_EQ(all.at("models").size(), 2u);
  EXPECT_EQ(all.at("unit"), 5);
  EXPECT_EQ(all.at("models")[0].at("halfBox"), json({0.1, 0.2, 0.5}));
  EXPECT_EQ(all.at("models")[1].at("halfBox"), json({0.2, 0.4, 1.0}));
  EXPECT_EQ(all.at("highestShare"), 0.5);
  input.models.push_back(half);
  EXPECT_THROW(view_page(input), std::logic_error);
}

TEST(Page, CountsTheTrianglesOfTheMeshThatWasSubmitted) {
  ViewModel model = sample_model();
  EXPECT_EQ(facts(view_page(page_of(model))).at("triangles"), model.mesh.triangles.size());
  model.job.mutable_prepared()->set_triangles(8);  // before they were cut where parts meet
  EXPECT_EQ(facts(view_page(page_of(model))).at("triangles"), 8);
}

TEST(Page, TellsWarningsAndPieces) {
  ViewModel model = sample_model();
  model.job.mutable_prepared()->set_points(2000);
  EXPECT_TRUE(facts(view_page(page_of(model))).at("warnings").empty());
  model.job.mutable_prepared()->set_points(1999);
  EXPECT_TRUE(facts(view_page(page_of(model))).at("pieces").empty());
  model.job.mutable_prepared()->add_notes()->set_message("faces were turned");
  model.job.mutable_repair()->add_steps()->set_message("1 hole filled");
  v1::RepairStep& closed = *model.job.mutable_repair()->add_steps();
  closed.set_severity("warning");
  closed.set_message("1 cavity closed");
  model.quality.set_points(2);
  model.quality.set_components(13);
  model.quality.set_solid_components(1);
  model.quality.set_holes(3);
  model.quality.set_solid_genus(2);
  model.quality.set_advice("a lower threshold joins the pieces");
  const json all = facts(view_page(page_of(model)));
  const json& warnings = all.at("warnings");
  ASSERT_EQ(warnings.size(), 6u);
  EXPECT_EQ(warnings[0], "repaired: 1 hole filled");
  EXPECT_EQ(warnings[1], "1 cavity closed");
  EXPECT_EQ(warnings[2], "faces were turned");
  EXPECT_NE(warnings[3].get<std::string>().find("coarse, 1999 points"), std::string::npos);
  EXPECT_NE(warnings[4].get<std::string>().find("in 13 pieces, the solid in 1"), std::string::npos);
  EXPECT_EQ(warnings[5], "the skeleton: a lower threshold joins the pieces");
  EXPECT_EQ(all.at("pieces"), json::array({json::array({"pieces", "13 (solid: 1)"}),
                                           json::array({"tunnels", "3 (solid: 2)"})}));
}

TEST(Page, NoNameBreaksOutOfItsElement) {
  ViewInput input = sample_input();
  const std::string name = "</script><script>alert(\"1\")</script> & 'x' <!-- {{script}} \\u003c ü€𝄞";
  input.models[0].job.set_name(name);
  const std::string page = view_page(input);
  EXPECT_EQ(facts(page).at("name"), name);
  EXPECT_EQ(element(page, "facts").find_first_of("<>&"), std::string::npos);
  EXPECT_EQ(page.find("alert(\"1\")</script>"), std::string::npos);
  const std::string shown =
      "&lt;/script&gt;&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; &#39;x&#39;";
  EXPECT_NE(page.find("<title>" + shown), std::string::npos);
  EXPECT_NE(page.find("<h1>" + shown), std::string::npos);
  EXPECT_LT(page.size(), view_page(sample_input()).size() + 2000) << "the name's own mark was filled";
}

TEST(Page, NamesThatAreNoUtf8AreShownAsFarAsTheyAre) {
  ViewInput input = sample_input();
  input.models[0].job.set_name("c\xFF");
  EXPECT_EQ(facts(view_page(input)).at("name"), "c\xEF\xBF\xBD");
}

TEST(Page, AsksForNothing) {
  const std::string page = view_page(sample_input());
  // The policy forbids it; no element tries.
  EXPECT_NE(page.find("Content-Security-Policy\"\n  content=\"default-src 'none'"), std::string::npos);
  std::string markup = page;
  const std::size_t script = markup.rfind("<script>");
  const std::size_t end = markup.rfind("</script>");
  const std::string program = markup.substr(script + 8, end - script - 8);
  EXPECT_EQ(program.find("</script"), std::string::npos);
  EXPECT_EQ(program.find("<!--"), std::string::npos);
  markup.erase(script, end - script);
  const std::regex link("(src|href)=\"(?!data:,)");
  EXPECT_FALSE(std::regex_search(markup, link));
  EXPECT_EQ(markup.find("@import"), std::string::npos);
  EXPECT_EQ(markup.find("{{"), std::string::npos) << "a mark was not filled";
}

TEST(Page, KeepsTheLicenceOfThreeJs) {
  const std::string page = view_page(sample_input());
  EXPECT_NE(page.find("three.js authors"), std::string::npos);
  EXPECT_NE(page.find("THE SOFTWARE IS PROVIDED \"AS IS\""), std::string::npos);
}

TEST(Page, SaysHowBodiesStandAndThatColoursAreNotLinear) {
  ViewInput input = sample_input();
  input.stance = {{1, false}, {2, false}};
  const json all = page_facts(view_page(input));
  EXPECT_EQ(all.at("stands"), "y up, facing z");
  EXPECT_EQ(all.at("stance").at("front"), json({0., 0., 1.}));
  EXPECT_EQ(all.at("scaleTitle"), "Erosion level E, % of v0");
  EXPECT_EQ(all.at("scaleNote"), "Not linear: the colour follows the cube root of E");
}

TEST(Page, NothingToDrawIsAnError) {
  ViewInput input = sample_input();
  input.models[0].mesh.triangles.clear();
  EXPECT_THROW(view_page(input), ClientError);
}

}  // namespace
}  // namespace affskel::client
