// The commands skeleton and surface, against a server in this process.
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "client/files/read/read_shape.h"
#include "client_fixture.h"
#include "sample_data.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

TEST_F(ClientTest, SkeletonAndSurfaceSendTheirParameters) {
  EXPECT_EQ(run({"skeleton", "@last", "--threshold", "3.5", "-o", dir_ / "s.ply"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().surface().skeleton().threshold(), 3.5);
  EXPECT_EQ(run({"skeleton", "@last", "-o", dir_ / "s.csv"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().skeleton().operator_(), v1::OPERATOR_RIDGE) << "the job's";
  EXPECT_EQ(run({"surface", "@last", "--alpha", "120000", "-o", dir_ / "s.off"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().surface().alpha(), 120000);
  EXPECT_EQ(run({"surface", "@last", "--threshold", "2", "-o", dir_ / "s.off"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().surface().skeleton().threshold(), 2);
}

// Which artefact is asked for, by operator, form and extension.
TEST_F(ClientTest, ASkeletonIsAComplexWhereItMayBe) {
  constexpr auto kComplex = v1::ARTIFACT_KIND_SURFACE, kPoints = v1::ARTIFACT_KIND_SKELETON;
  const auto asked = [&](const std::vector<std::string>& options, const std::string& extension) {
    std::vector<std::string> command = {"skeleton", "@last", "-o", dir_ / ("s" + extension)};
    command.insert(command.end(), options.begin(), options.end());
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return service_.fetches.back().kind();
  };
  for (const char* extension : {".vtp", ".ply", ".obj", ".stl", ".off"}) {
    EXPECT_EQ(asked({}, extension), kComplex) << extension;
    EXPECT_EQ(asked({"--as", "complex", "--operator", "sobel"}, extension), kComplex) << extension;
  }
  for (const char* extension : {".csv", ".xyz"}) EXPECT_EQ(asked({}, extension), kPoints) << extension;
  EXPECT_EQ(asked({"--as", "points"}, ".ply"), kPoints);
  EXPECT_EQ(asked({"--operator", "sobel"}, ".vtp"), kPoints);
  EXPECT_EQ(asked({"--operator", "sobel"}, ".stl"), kComplex) << "which holds nothing else";
  EXPECT_EQ(asked({"--operator", "sobel", "--alpha", "4"}, ".ply"), kComplex);
  EXPECT_EQ(run({"skeleton", "@last", "--as", "complex", "-o", dir_ / "s.csv"}).exit_code, 2);
  EXPECT_EQ(run({"skeleton", "@last", "--as", "points", "-o", dir_ / "s.stl"}).exit_code, 2);
  const Outcome refused = run({"skeleton", "@last", "--barrier", "-o", dir_ / "s.csv"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("cannot write the skeleton with barriers as '.csv'"), std::string::npos)
      << refused.err;
  EXPECT_EQ(run({"skeleton", "@last", "--operator", "sobel", "--alpha", "4", "-o", dir_ / "s.xyz"}).exit_code,
            2);
  EXPECT_EQ(run({"skeleton", "@last", "--as", "points", "--barrier", "-o", dir_ / "s.ply"}).exit_code, 2);
}

TEST_F(ClientTest, SurfaceAsksForBarriers) {
  const std::string file = dir_ / "s.ply";
  ASSERT_EQ(run({"surface", "@last", "--barrier", "-o", file}).exit_code, 0);
  EXPECT_TRUE(service_.fetches.back().surface().barrier());
  EXPECT_EQ(service_.fetches.back().surface().min_barrier(), 0);
  ASSERT_EQ(run({"surface", "@last", "--operator", "ridge", "--min-barrier", "0.05", "-o", file}).exit_code,
            0);
  EXPECT_TRUE(service_.fetches.back().surface().barrier()) << "--min-barrier implies it";
  EXPECT_EQ(service_.fetches.back().surface().min_barrier(), 0.05);
  EXPECT_NE(tests::read_file(file).find("barriers from 0.05"), std::string::npos);
  EXPECT_EQ(run({"surface", "@last", "--min-barrier", "-1", "-o", file}).exit_code, 2);
  EXPECT_EQ(run({"surface", "@last", "--min-barrier", "0", "-o", file}).exit_code, 2);
}

TEST_F(ClientTest, AThresholdAloneIsForTheJobsOperator) {
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  service_.job.mutable_skeleton()->set_threshold(0.02);
  ASSERT_EQ(
      run({"skeleton", "@last", "--threshold", "0.1", "--as", "points", "-o", dir_ / "s.ply"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().skeleton().operator_(), v1::OPERATOR_CHORDS);
  EXPECT_EQ(service_.fetches.back().skeleton().threshold(), 0.1);
  EXPECT_EQ(service_.fetches.back().job(), service_.job.id()) << "@last may be another job by then";
  EXPECT_NE(tests::read_file(dir_ / "s.ply").find("operator chords, threshold 0.1"), std::string::npos);
  ASSERT_EQ(run({"surface", "@last", "--threshold", "0.1", "-o", dir_ / "s.off"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().surface().skeleton().operator_(), v1::OPERATOR_CHORDS);
  EXPECT_EQ(service_.fetches.back().surface().skeleton().threshold(), 0.1);
}

TEST_F(ClientTest, AnOperatorAloneHasItsDefaultThreshold) {
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  service_.job.mutable_skeleton()->set_threshold(0.02);
  for (const auto& [name, which] :
       {std::pair("sobel", v1::OPERATOR_SOBEL), std::pair("chords", v1::OPERATOR_CHORDS)}) {
    ASSERT_EQ(run({"skeleton", "@last", "--operator", name, "-o", dir_ / "s.csv"}).exit_code, 0);
    EXPECT_EQ(service_.fetches.back().skeleton().operator_(), which);
    EXPECT_EQ(service_.fetches.back().skeleton().threshold(), 0) << "the operator's default";
  }
}

TEST_F(ClientTest, CurvesAreToldAndMissedWhereTheyHaveNoPlace) {
  v1::TriangleMesh sheet = sample_sheet();
  for (const double v : {0., 0., 3000.}) sheet.add_xyz(v);
  for (const double area : {3., 4., 5., 100 * std::numbers::pi}) sheet.add_area(area);
  sheet.add_erosion(6);
  sheet.add_strength(9);
  for (const unsigned v : {2u, 3u}) sheet.add_segments(v);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  const Outcome vtp = run({"--json", "surface", "@last", "-o", dir_ / "p.vtp"});
  EXPECT_NE(vtp.err.find("1 triangle, 1 segment of curves"), std::string::npos) << vtp.err;
  EXPECT_EQ(json::parse(vtp.out).at("segments"), 1);
  const std::string facts = run({"inspect", dir_ / "p.vtp"}).out;
  EXPECT_NE(facts.find(" of curves\n"), std::string::npos) << "which have no line: " << facts;
  const ShapeFile shape = read_shape(dir_ / "p.vtp");
  EXPECT_EQ(shape.segments, (std::vector<core::Segment>{{2, 3}}));
  EXPECT_DOUBLE_EQ(shape.column("radius")->values[3], 10);
  for (const char* name : {"p.ply", "p.obj"}) {
    ASSERT_EQ(run({"skeleton", "@last", "-o", dir_ / name}).exit_code, 0);
    EXPECT_EQ(read_shape(dir_ / name).segments, (std::vector<core::Segment>{{2, 3}})) << name;
    EXPECT_EQ(read_shape(dir_ / name).mesh().triangles.size(), 1u) << name;
  }
  const Outcome stl = run({"surface", "@last", "-o", dir_ / "p.stl"});
  EXPECT_NE(stl.err.find("without the curves (1 segment)"), std::string::npos) << stl.err;
  EXPECT_EQ(stl.err.find("segment of curves"), std::string::npos) << stl.err;
  EXPECT_EQ(run({"perturb", dir_ / "p.vtp", "--noise", "1%", "-o", dir_ / "n.vtp"}).err.find("no place"),
            std::string::npos);
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "p.png"}).exit_code, 0);
  EXPECT_EQ(run({"compare", dir_ / "p.vtp", dir_ / "p.stl", "--json"}).exit_code, 0);
  v1::TriangleMesh alone = sheet;
  alone.clear_corners();
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = alone.SerializeAsString();
  const Outcome lost = run({"surface", "@last", "-o", dir_ / "alone.stl"});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_NE(lost.err.find("of curves alone"), std::string::npos) << lost.err;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "alone.stl"));
  EXPECT_EQ(run({"surface", "@last", "-o", dir_ / "alone.obj"}).exit_code, 0);
  sheet.add_segments(4);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  EXPECT_EQ(run({"surface", "@last", "-o", dir_ / "p.vtp"}).exit_code, 70) << "half a segment";
  sheet.add_segments(0);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  EXPECT_EQ(run({"surface", "@last", "-o", dir_ / "p.vtp"}).exit_code, 70) << "no vertex 4";
}

TEST_F(ClientTest, QualityIsToldEverywhere) {
  v1::SkeletonPoints skeleton = sample_skeleton();
  skeleton.mutable_quality()->set_points(2);
  skeleton.mutable_quality()->set_components(1);
  skeleton.mutable_quality()->set_inside_share(1);
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = skeleton.SerializeAsString();
  *service_.job.mutable_quality() = skeleton.quality();
  EXPECT_EQ(run({"skeleton", "@last", "--as", "points", "-o", dir_ / "s.ply"}).exit_code, 0);
  EXPECT_NE(tests::read_file(dir_ / "s.ply").find("comment quality betti: 1, 0, 0"), std::string::npos);
  EXPECT_NE(run({"status", "@last"}).out.find("skeleton_inside:      100 %"), std::string::npos);
  EXPECT_EQ(json::parse(run({"--json", "status", "@last"}).out).at("quality").at("components"), 1);
  skeleton.mutable_quality()->set_advice("take more directions");
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = skeleton.SerializeAsString();
  EXPECT_NE(
      run({"skeleton", "@last", "--as", "points", "-o", dir_ / "s.ply"}).err.find("take more directions"),
      std::string::npos);
}

TEST_F(ClientTest, EmptyResultsAreToldWithTheirAdvice) {
  v1::SkeletonPoints skeleton;
  skeleton.mutable_quality()->set_advice("take more directions.");
  v1::Setting& setting = *skeleton.mutable_quality()->add_to_try();
  setting.set_name("min_barrier");
  setting.set_value("0.2");
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = skeleton.SerializeAsString();
  const Outcome points = run({"--json", "skeleton", "@last", "--threshold", "99", "-o", dir_ / "s.csv"});
  EXPECT_EQ(points.exit_code, 0) << points.err;
  EXPECT_EQ(json::parse(points.out).at("points"), 0);
  EXPECT_EQ(json::parse(points.out).at("quality").at("advice"), "take more directions.");
  EXPECT_EQ(json::parse(points.out).at("quality").at("to_try").at(0).at("value"), "0.2");
  EXPECT_NE(points.err.find("take more directions. Try --min-barrier 0.2\n"), std::string::npos)
      << points.err;

  v1::TriangleMesh sheet;
  sheet.mutable_quality()->set_advice("take a smaller significance");
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  const Outcome chords = run({"surface", "@last", "--operator", "chords", "-o", dir_ / "c.ply"});
  EXPECT_NE(chords.err.find("the surface is empty: take a smaller significance"), std::string::npos);
  EXPECT_EQ(chords.err.find("alpha"), std::string::npos) << "chords have none";
  const Outcome alpha = run({"surface", "@last", "--operator", "zucker-hummel", "-o", dir_ / "a.ply"});
  EXPECT_NE(alpha.err.find("a larger alpha"), std::string::npos) << alpha.err;
}

TEST_F(ClientTest, SheetsOfChordsKeepTheirProperties) {
  v1::TriangleMesh sheet;
  for (const double v : {0., 0., 0., 1., 0., 0., 0., 1., 0.}) sheet.add_xyz(v);
  for (const unsigned c : {0u, 1u, 2u}) sheet.add_corners(c);
  for (const double e : {3., 4., 5.}) sheet.add_erosion(e);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  EXPECT_EQ(run({"surface", "@last", "--operator", "chords", "-o", dir_ / "c.ply"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().surface().skeleton().operator_(), v1::OPERATOR_CHORDS);
  const std::string ply = tests::read_file(dir_ / "c.ply");
  EXPECT_NE(ply.find("property double E\n"), std::string::npos);
  EXPECT_EQ(ply.size(), ply.find("end_header\n") + 11 + 3 * (4 * 8 + 4 + 3) + 13);
  sheet.add_erosion(6);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  EXPECT_EQ(run({"surface", "@last", "-o", dir_ / "d.ply"}).exit_code, 70);
}

}  // namespace
}  // namespace affskel::client
