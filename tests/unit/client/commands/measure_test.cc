// The command measure, and fetch curve, against a server in this process.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>

#include "client_fixture.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

// A fork: a thick line of 4 along x, from its end thin ones of 3 and 5.
v1::TriangleMesh fork() {
  v1::TriangleMesh curve;
  for (const double c : {0., 0., 0., 4., 0., 0., 4., 3., 0., 7., -4., 0.}) curve.add_xyz(c);
  for (const std::uint32_t v : {0U, 1U, 1U, 2U, 1U, 3U}) curve.add_segments(v);
  for (const double e : {1., 9., 2., 3.}) curve.add_erosion(e);
  for (const double s : {1., 1., 1., 1.}) curve.add_strength(s);
  for (const double r : {2., 2., 1., 1.}) curve.add_area(std::numbers::pi * r * r);
  for (const double d : {1., 2., 1., 1.}) curve.add_distance(d);
  for (const double s : {0.4, 0.3, 0.1, 0.2}) curve.add_share(s);
  for (const double s : {0.2, 0.45, 0.05, 0.1}) curve.add_beyond(s);
  v1::SkeletonQuality& quality = *curve.mutable_quality();
  quality.set_points(4);
  quality.set_components(1);
  quality.set_solid_components(1);
  quality.set_branches(3);
  quality.set_ends(3);
  return curve;
}

class MeasureTest : public ClientTest {
 protected:
  MeasureTest() { service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = fork().SerializeAsString(); }
};

TEST_F(MeasureTest, TellsOfTheWholeAndItsPartsTheLargestFirst) {
  const Outcome outcome = run({"--json", "measure", "@last"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(service_.fetches.front().surface().skeleton().operator_(), v1::OPERATOR_CURVE);
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["whole"]["volume_units3"], 8e9);
  EXPECT_EQ(found["whole"]["surface_area_units2"], 6 * 2000.0 * 2000);  // of the cube
  EXPECT_EQ(found["whole"]["curve_length_units"], 12);
  EXPECT_EQ(found["whole"]["ends"], 3);
  ASSERT_EQ(found["parts"].size(), 3U);
  const json& first = found["parts"][0];
  EXPECT_EQ(first["part"], 1);
  EXPECT_EQ(first["kind"], "limb");
  EXPECT_EQ(first["length_units"], 4);
  EXPECT_NEAR(first["volume_share"].get<double>(), 0.4 + 0.3 / 3, 1e-12);
  EXPECT_NEAR(first["volume_units3"].get<double>(), 8e9 * 0.5, 1);
  EXPECT_NEAR(first["mean_radius_units"].get<double>(), 2, 1e-12);
  EXPECT_EQ(first["from_x"], 4) << "from where it hangs on";
  EXPECT_EQ(first["to_x"], 0);
  EXPECT_EQ(found["parts"][1]["length_units"], 5);
  EXPECT_EQ(found["parts"][2]["length_units"], 3);
  EXPECT_NEAR(found["parts"][2]["mean_radius_units"].get<double>(), 1.5, 1e-12);
  double sum = 0;
  for (const json& part : found["parts"]) sum += part["volume_units3"].get<double>();
  EXPECT_NEAR(sum, 8e9, 1e-9 * 8e9);
}

TEST_F(MeasureTest, WritesATable) {
  const std::string csv = dir_ / "limbs.csv";
  ASSERT_EQ(run({"measure", "@last", "--threshold", "2", "-o", csv}).exit_code, 0);
  EXPECT_EQ(service_.fetches.front().surface().skeleton().threshold(), 2);
  std::istringstream lines(tests::read_file(csv));
  std::string head, row;
  ASSERT_TRUE(std::getline(lines, head) && std::getline(lines, row));
  EXPECT_TRUE(head.starts_with("part,kind,length_units,straight_length_units,volume_units3"));
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_TRUE(row.starts_with("1,limb,4,4,")) << row;
  const std::string file = dir_ / "limbs.json";
  ASSERT_EQ(run({"measure", "@last", "-o", file}).exit_code, 0);
  EXPECT_EQ(json::parse(tests::read_file(file))["parts"].size(), 3U);
  const Outcome shown = run({"measure", "@last"});
  EXPECT_NE(shown.out.find("surface_area:"), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("\n    1  limb          50"), std::string::npos) << shown.out;
}

TEST_F(MeasureTest, ASolidWithoutLimbsHasNoParts) {
  v1::TriangleMesh place = fork();
  place.clear_segments();
  place.mutable_quality()->set_advice("no limb");
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = place.SerializeAsString();
  const Outcome outcome = run({"measure", "@last"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("no limb"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("parts:                0\n"), std::string::npos) << outcome.out;
}

TEST_F(MeasureTest, RefusesOtherFormats) {
  EXPECT_EQ(run({"measure", "@last", "-o", dir_ / "limbs.xlsx"}).exit_code, 2);
  EXPECT_EQ(run({"measure", "@last", "--threshold", "0"}).exit_code, 2);
  EXPECT_TRUE(service_.fetches.empty()) << "before anything is asked";
}

TEST_F(MeasureTest, FetchWritesTheCurveAsAGraph) {
  const std::string file = dir_ / "curve.json";
  ASSERT_EQ(run({"fetch", "@last", "curve", "-o", file}).exit_code, 0);
  const json graph = json::parse(tests::read_file(file));
  EXPECT_EQ(graph["nodes"].size(), 4U);
  EXPECT_EQ(graph["branches"].size(), 3U);
  v1::TriangleMesh looped = fork();
  looped.mutable_quality()->set_holes(1);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = looped.SerializeAsString();
  const Outcome outcome = run({"fetch", "@last", "curve", "-o", dir_ / "curve.swc"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("1 loop cut"), std::string::npos) << outcome.err;
  EXPECT_EQ(run({"fetch", "@last", "curve", "-o", dir_ / "curve.csv"}).exit_code, 2);
}

}  // namespace
}  // namespace affskel::client
