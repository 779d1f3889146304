// Commands that write results, against a server in this process.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <vector>

#include "client/files/format.h"
#include "client/files/read/read_shape.h"
#include "client_fixture.h"
#include "core/text/off_file.h"
#include "sample_data.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

TEST_F(ClientTest, FetchWritesWhatTheExtensionSays) {
  EXPECT_EQ(run({"fetch", "@last", "field", "-o", dir_ / "f.csv"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "f.csv").substr(0, 27), "x,y,z,E,nx,ny,nz,direction\n");
  EXPECT_EQ(run({"fetch", "@last", "skeleton", "-o", dir_ / "s.xyz"}).exit_code, 0);
  EXPECT_EQ(run({"fetch", "@last", "surface", "-o", dir_ / "s.stl"}).exit_code, 0);
  EXPECT_EQ(run({"fetch", "@last", "mesh", "-o", dir_ / "mesh"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "mesh"), mesh_);
  EXPECT_FALSE(service_.fetches.back().has_skeleton());
  EXPECT_EQ(run({"fetch", "@last", "field", "-o", dir_ / "f.ply"}).exit_code, 2);
  EXPECT_EQ(run({"fetch", "@last", "volume", "-o", dir_ / "f.ply"}).exit_code, 2);
}

TEST_F(ClientTest, TheMeshIsFetchedInAnyFormatOfSurfaces) {
  const core::Mesh submitted = core::read_off(mesh_).mesh;
  for (const FileFormat format : surface_formats()) {
    const std::string file = dir_ / ("m" + std::string(extension_of(format)));
    const Outcome outcome = run({"fetch", "@last", "mesh", "-o", file});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const core::Mesh fetched = read_shape(file).mesh();
    EXPECT_EQ(fetched.triangles.size(), submitted.triangles.size()) << file;
    EXPECT_EQ(fetched.points.size(), submitted.points.size()) << file;
    EXPECT_EQ(tests::read_file(file) == mesh_, format == FileFormat::kOff) << file;
  }
  EXPECT_NE(tests::read_file(dir_ / "m.obj").find("# job " + service_.job.id()), std::string::npos);
  EXPECT_EQ(run({"fetch", "@last", "mesh", "-o", dir_ / "m.csv"}).exit_code, 2);
}

TEST_F(ClientTest, FetchPrintsNothingOnStandardOutputButJson) {
  EXPECT_EQ(run({"fetch", "@last", "skeleton", "-o", dir_ / "s.csv"}).out, "");
  const json document = json::parse(run({"--json", "fetch", "@last", "skeleton", "-o", dir_ / "s.csv"}).out);
  EXPECT_EQ(document.at("points"), 2);
  EXPECT_EQ(document.at("file"), dir_ / "s.csv");
}

TEST_F(ClientTest, ResultsGoToTheStandardOutput) {
  const std::vector<std::vector<std::string>> commands = {
      {"fetch", "@last", "field", "--format", "csv"},
      {"fetch", "@last", "field", "--format", "vtkhdf"},
      {"fetch", "@last", "mesh"},
      {"skeleton", "@last", "--format", "ply"},
      {"surface", "@last", "--format", ".STL"},
      {"erode", "@last", "--volume", "3", "--format", "xyz"},
      {"render", "@last", "--width", "300"}};
  for (std::vector<std::string> command : commands) {
    command.insert(command.end(), {"-o", "-"});
    ::testing::internal::CaptureStdout();
    const Outcome outcome = run(command);
    const std::string piped = ::testing::internal::GetCapturedStdout();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("wrote standard output"), std::string::npos) << outcome.err;
    command.back() = dir_ / "file";
    if (command[0] == "render") command.back() += ".png";
    ASSERT_EQ(run(command).exit_code, 0) << command[0];
    EXPECT_EQ(piped, tests::read_file(command.back())) << command[0];
    command.back() = "-";
    command.insert(command.begin(), "--json");
    EXPECT_EQ(run(command).exit_code, 2) << "both want standard output";
  }
  EXPECT_EQ(run({"skeleton", "@last", "-o", "-"}).exit_code, 2) << "as what?";
  EXPECT_EQ(run({"fetch", "@last", "mesh", "-o", "-", "--format", "csv"}).exit_code, 2);
}

TEST_F(ClientTest, APlaceThatCannotBeWrittenIsKnownBeforeTheWorkIsDone) {
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"skeleton", "@last", "--operator", "sobel", "-o", "/nowhere/s.ply"},
           {"surface", "@last", "--operator", "chords", "-o", "/nowhere/s.ply"},
           {"erode", "@last", "--fraction", "1%", "-o", "/nowhere/s.ply"},
           {"erode", "@last", "--fraction", "1%", "-o", "/nowhere/s.csv"},
           {"render", "@last", "-o", "/nowhere/s.png"}}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("cannot write: No such file"), std::string::npos) << outcome.err;
  }
  EXPECT_TRUE(service_.fetches.empty());
}

TEST_F(ClientTest, AFormatStandsAboveTheExtension) {
  EXPECT_EQ(run({"skeleton", "@last", "-o", dir_ / "s.txt", "--format", "csv"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "s.txt").substr(0, 6), "x,y,z,");
  EXPECT_EQ(run({"erode", "@last", "--volume", "3", "-o", dir_ / "e.csv", "--format", "stl"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().kind(), v1::ARTIFACT_KIND_ERODED_SURFACE);
}

TEST_F(ClientTest, DamagedTransfersLeaveNoFile) {
  service_.damage = true;
  for (const auto& [kind, name] : {std::pair("mesh", "m.off"), std::pair("skeleton", "s.ply"),
                                   std::pair("surface", "s.obj"), std::pair("field", "f.csv")}) {
    const Outcome outcome = run({"fetch", "@last", kind, "-o", dir_ / name});
    EXPECT_EQ(outcome.exit_code, 70) << kind;
    EXPECT_NE(outcome.err.find("SHA-256"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(dir_ / name)) << kind;
  }
  EXPECT_EQ(dir_.names().size(), 3u) << "only the inputs";
}

TEST_F(ClientTest, AFieldThatIsNotFinishedIsNoSuchArtefact) {
  service_.job = sample_job(v1::JOB_STATE_RUNNING);
  const Outcome outcome = run({"fetch", "@last", "field", "-o", dir_ / "f.csv"});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.err.find("5 of 12"), std::string::npos);
  service_.artifacts.erase(v1::ARTIFACT_KIND_SKELETON);
  EXPECT_EQ(run({"fetch", "@last", "skeleton", "-o", dir_ / "s.csv"}).exit_code, 4);
}

TEST_F(ClientTest, SkeletonAndSurfaceSendTheirParameters) {
  EXPECT_EQ(run({"skeleton", "@last", "--threshold", "3.5", "-o", dir_ / "s.ply"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().skeleton().threshold(), 3.5);
  EXPECT_EQ(run({"skeleton", "@last", "-o", dir_ / "s.ply"}).exit_code, 0);
  EXPECT_FALSE(service_.fetches.back().has_skeleton());
  EXPECT_EQ(run({"surface", "@last", "--alpha", "120000", "-o", dir_ / "s.off"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().surface().alpha(), 120000);
  EXPECT_FALSE(service_.fetches.back().surface().has_skeleton());
  EXPECT_EQ(run({"surface", "@last", "--threshold", "2", "-o", dir_ / "s.off"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().surface().skeleton().threshold(), 2);
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
  ASSERT_EQ(run({"skeleton", "@last", "--threshold", "0.1", "-o", dir_ / "s.ply"}).exit_code, 0);
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
    ASSERT_EQ(run({"skeleton", "@last", "--operator", name, "-o", dir_ / "s.ply"}).exit_code, 0);
    EXPECT_EQ(service_.fetches.back().skeleton().operator_(), which);
    EXPECT_EQ(service_.fetches.back().skeleton().threshold(), 0) << "the operator's default";
  }
}

TEST_F(ClientTest, RenderWritesAPng) {
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "p.png", "--width", "300"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "p.png").substr(1, 3), "PNG");
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "p.png", "--width", "3"}).exit_code, 2);
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "p.jpg"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "p.jpg"));
}

TEST_F(ClientTest, RenderDrawsTheSkeletonThatIsAskedFor) {
  const std::string plain = dir_ / "p.png", other = dir_ / "q.png";
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_SOBEL);
  ASSERT_EQ(run({"render", "@last", "-o", plain, "--width", "300"}).exit_code, 0);
  EXPECT_FALSE(service_.fetches.front().has_skeleton()) << "the job's own, which is stored";
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_ZUCKER_HUMMEL);
  service_.fetches.clear();
  ASSERT_EQ(run({"render", "@last", "--threshold", "3", "-o", other}).exit_code, 0);
  EXPECT_EQ(service_.fetches.front().kind(), v1::ARTIFACT_KIND_SKELETON);
  EXPECT_EQ(service_.fetches.front().skeleton().threshold(), 3);
  EXPECT_EQ(service_.fetches.front().skeleton().operator_(), v1::OPERATOR_ZUCKER_HUMMEL);

  v1::TriangleMesh sheet = sample_sheet();
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  service_.fetches.clear();
  ASSERT_EQ(run({"render", "@last", "--operator", "chords", "-o", other, "--width", "300"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.front().kind(), v1::ARTIFACT_KIND_SURFACE);
  EXPECT_EQ(service_.fetches.front().surface().skeleton().operator_(), v1::OPERATOR_CHORDS);
  EXPECT_NE(tests::read_file(plain), tests::read_file(other));
  sheet.add_corners(9);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  EXPECT_EQ(run({"render", "@last", "--operator", "chords", "-o", other}).exit_code, 70) << "a damaged sheet";
}

TEST_F(ClientTest, ThePublishedSkeletonIsShownByItsRidge) {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"render", "@last", "-o", dir_ / "p.png", "--width", "300"},
        {"view", "@last", "-o", dir_ / "p.html"},
        {"surface", "@last", "-o", dir_ / "p.ply"},
        {"fetch", "@last", "surface", "-o", dir_ / "p.ply"}}) {
    service_.fetches.clear();
    ASSERT_EQ(run(command).exit_code, 0) << command[0];
    const auto& asked = service_.fetches;
    EXPECT_TRUE(std::any_of(asked.begin(), asked.end(), [](const v1::FetchArtifactRequest& request) {
      return request.kind() == v1::ARTIFACT_KIND_SURFACE &&
             request.surface().skeleton().operator_() == v1::OPERATOR_RIDGE;
    })) << command[0];
  }
  // A threshold is one of the job's operator, an alpha shape one of its points, another operator wanted.
  run({"surface", "@last", "--threshold", "6", "-o", dir_ / "p.ply"});
  EXPECT_EQ(service_.fetches.back().surface().skeleton().operator_(), v1::OPERATOR_ZUCKER_HUMMEL);
  run({"surface", "@last", "--alpha", "6", "-o", dir_ / "p.ply"});
  EXPECT_FALSE(service_.fetches.back().surface().has_skeleton());
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_FLUX);
  run({"surface", "@last", "-o", dir_ / "p.ply"});
  EXPECT_EQ(service_.fetches.back().surface().skeleton().operator_(), v1::OPERATOR_FLUX);
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
  const ShapeFile shape = read_shape(dir_ / "p.vtp");
  EXPECT_EQ(shape.segments, (std::vector<core::Segment>{{2, 3}}));
  EXPECT_DOUBLE_EQ(shape.column("radius")->values[3], 10);
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

TEST_F(ClientTest, RenderOfAnEmptySheetSaysWhy) {
  v1::TriangleMesh sheet;
  sheet.mutable_quality()->set_advice("take a smaller significance");
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  const Outcome outcome = run({"render", "@last", "-o", dir_ / "p.png", "--width", "300"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("empty: take a smaller significance"), std::string::npos) << outcome.err;
  service_.job = sample_job(v1::JOB_STATE_RUNNING);
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "q.png"}).exit_code, 4);
}

TEST_F(ClientTest, DivergencesComeWithTheirPlaces) {
  EXPECT_EQ(run({"fetch", "@last", "divergence", "-o", dir_ / "H.csv"}).exit_code, 0);
  const std::string text = tests::read_file(dir_ / "H.csv");
  EXPECT_EQ(text.substr(0, 8), "x,y,z,H\n");
  EXPECT_NE(text.find(",-7.25\n"), std::string::npos) << text;
  EXPECT_FALSE(service_.fetches.back().has_skeleton()) << "the job's own operator";
  EXPECT_EQ(run({"fetch", "@last", "divergence", "--operator", "sobel", "-o", dir_ / "H.dat"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().skeleton().operator_(), v1::OPERATOR_SOBEL);
  EXPECT_EQ(run({"fetch", "@last", "divergence", "-o", dir_ / "H.vtkhdf"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "H.vtkhdf").substr(1, 3), "HDF");
  EXPECT_EQ(run({"fetch", "@last", "mesh", "--operator", "sobel", "-o", dir_ / "m.off"}).exit_code, 2);
  service_.artifacts[v1::ARTIFACT_KIND_DIVERGENCE].resize(4 * 8);
  EXPECT_EQ(run({"fetch", "@last", "divergence", "-o", dir_ / "short.csv"}).exit_code, 70);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "short.csv"));
}

TEST_F(ClientTest, ErodeWritesPointsOrASurface) {
  EXPECT_EQ(run({"erode", "@last", "--fraction", "0.25", "-o", dir_ / "e.stl"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().kind(), v1::ARTIFACT_KIND_ERODED_SURFACE);
  EXPECT_EQ(service_.fetches.back().eroded().fraction(), 0.25);
  EXPECT_EQ(run({"erode", "@last", "--volume", "3e9", "-o", dir_ / "e.csv"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().kind(), v1::ARTIFACT_KIND_ERODED_POINTS);
  EXPECT_EQ(service_.fetches.back().eroded().volume(), 3e9);
  EXPECT_EQ(tests::read_file(dir_ / "e.csv").substr(0, 27), "x,y,z,E,nx,ny,nz,direction\n");
  EXPECT_EQ(run({"erode", "@last", "--volume", "3", "--as", "points", "-o", dir_ / "e.ply"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "e.ply").find("property double H"), std::string::npos);
  EXPECT_EQ(run({"erode", "@last", "--volume", "3", "-o", dir_ / "E.STL"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().kind(), v1::ARTIFACT_KIND_ERODED_SURFACE);
  const Outcome told = run({"--json", "erode", "@last", "--fraction", "0.5", "-o", dir_ / "e.ply"});
  EXPECT_EQ(json::parse(told.out).at("volume"), 8e8);
  EXPECT_NE(tests::read_file(dir_ / "e.ply").find("volume 8e+08"), std::string::npos);
  EXPECT_EQ(run({"erode", "@last", "--fraction", "7%", "-o", dir_ / "e.stl"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().eroded().fraction(), 0.07);
  EXPECT_EQ(run({"fetch", "@last", "eroded", "-o", dir_ / "f.off"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().eroded().fraction(), 0.1);
}

TEST_F(ClientTest, ErodedPointsTellTheirShareOfTheVolume) {
  // Two of the five sample points of a solid of 8e9.
  const Outcome told = run({"erode", "@last", "--fraction", "0.1", "-o", dir_ / "e.ply", "--as", "points"});
  EXPECT_NE(told.err.find("2 points, volume about 3.2e+09"), std::string::npos) << told.err;
  EXPECT_NE(tests::read_file(dir_ / "e.ply").find("volume about 3.2e+09"), std::string::npos);
  const json document =
      json::parse(run({"--json", "erode", "@last", "--fraction", "0.1", "-o", dir_ / "e.csv"}).out);
  EXPECT_DOUBLE_EQ(document.at("volume"), 3.2e9);
  EXPECT_FALSE(json::parse(run({"--json", "fetch", "@last", "skeleton", "-o", dir_ / "s.csv"}).out)
                   .contains("volume"));
}

TEST_F(ClientTest, AnEmptyErodedSolidSaysWhatTheLargestLevelIs) {
  v1::SkeletonPoints none;
  none.mutable_quality()->set_advice("the largest E is 12");
  service_.artifacts[v1::ARTIFACT_KIND_ERODED_POINTS] = none.SerializeAsString();
  v1::TriangleMesh nothing;
  nothing.mutable_quality()->set_advice("the largest E is 13");
  service_.artifacts[v1::ARTIFACT_KIND_ERODED_SURFACE] = nothing.SerializeAsString();
  const Outcome points = run({"--json", "erode", "@last", "--fraction", "0.9", "-o", dir_ / "e.csv"});
  EXPECT_EQ(json::parse(points.out).at("volume"), 0);
  EXPECT_NE(run({"erode", "@last", "--fraction", "0.9", "-o", dir_ / "e.csv"}).err.find("largest E is 12"),
            std::string::npos);
  EXPECT_NE(run({"erode", "@last", "--fraction", "0.9", "-o", dir_ / "e.off"}).err.find("largest E is 13"),
            std::string::npos);
}

TEST_F(ClientTest, ErodeRefusesWrongLevels) {
  for (const std::vector<std::string>& level :
       std::vector<std::vector<std::string>>{{},
                                             {"--fraction", "0"},
                                             {"--fraction", "1.5"},
                                             {"--fraction", "1"},
                                             {"--fraction", "100%"},
                                             {"--fraction", "10%%"},
                                             {"--volume", "-1"},
                                             {"--fraction", "0.5", "--volume", "1"}}) {
    std::vector<std::string> arguments = {"erode", "@last", "-o", dir_ / "e.off"};
    arguments.insert(arguments.end(), level.begin(), level.end());
    EXPECT_EQ(run(arguments).exit_code, 2) << level.size();
  }
  EXPECT_EQ(run({"erode", "@last", "--fraction", "0.5", "--as", "points", "-o", dir_ / "e.stl"}).exit_code,
            2);
}

TEST_F(ClientTest, QualityIsToldEverywhere) {
  v1::SkeletonPoints skeleton = sample_skeleton();
  skeleton.mutable_quality()->set_points(2);
  skeleton.mutable_quality()->set_components(1);
  skeleton.mutable_quality()->set_inside_share(1);
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = skeleton.SerializeAsString();
  *service_.job.mutable_quality() = skeleton.quality();
  EXPECT_EQ(run({"fetch", "@last", "skeleton", "-o", dir_ / "s.ply"}).exit_code, 0);
  EXPECT_NE(tests::read_file(dir_ / "s.ply").find("comment quality betti: 1, 0, 0"), std::string::npos);
  EXPECT_NE(run({"status", "@last"}).out.find("skeleton_inside:      100 %"), std::string::npos);
  EXPECT_EQ(json::parse(run({"--json", "status", "@last"}).out).at("quality").at("components"), 1);
  skeleton.mutable_quality()->set_advice("take more directions");
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = skeleton.SerializeAsString();
  EXPECT_NE(run({"fetch", "@last", "skeleton", "-o", dir_ / "s.ply"}).err.find("take more directions"),
            std::string::npos);
}

TEST_F(ClientTest, EmptyResultsAreToldWithTheirAdvice) {
  v1::SkeletonPoints skeleton;
  skeleton.mutable_quality()->set_advice("take more directions");
  service_.artifacts[v1::ARTIFACT_KIND_SKELETON] = skeleton.SerializeAsString();
  const Outcome points = run({"--json", "skeleton", "@last", "--threshold", "99", "-o", dir_ / "s.ply"});
  EXPECT_EQ(points.exit_code, 0) << points.err;
  EXPECT_EQ(json::parse(points.out).at("points"), 0);
  EXPECT_EQ(json::parse(points.out).at("quality").at("advice"), "take more directions");

  v1::TriangleMesh sheet;
  sheet.mutable_quality()->set_advice("take a smaller significance");
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  const Outcome chords = run({"surface", "@last", "--operator", "chords", "-o", dir_ / "c.ply"});
  EXPECT_NE(chords.err.find("the surface is empty: take a smaller significance"), std::string::npos);
  EXPECT_EQ(chords.err.find("--alpha"), std::string::npos) << "chords have none";
  const Outcome alpha = run({"surface", "@last", "--operator", "zucker-hummel", "-o", dir_ / "a.ply"});
  EXPECT_NE(alpha.err.find("--alpha"), std::string::npos) << alpha.err;
}

TEST_F(ClientTest, AFieldOfAJobThatEndedBadlySaysHow) {
  service_.job = sample_job(v1::JOB_STATE_CANCELLED);
  const Outcome cancelled = run({"fetch", "@last", "field", "-o", dir_ / "f.csv"});
  EXPECT_EQ(cancelled.exit_code, 4);
  EXPECT_NE(cancelled.err.find("was cancelled at 5 of 12 directions"), std::string::npos) << cancelled.err;
  service_.job = sample_job(v1::JOB_STATE_FAILED);
  service_.job.mutable_error()->set_code("BAD_INPUT");
  service_.job.mutable_error()->set_message("an open edge");
  const Outcome failed = run({"fetch", "@last", "field", "-o", dir_ / "f.csv"});
  EXPECT_EQ(failed.exit_code, 4);
  EXPECT_NE(failed.err.find("failed: BAD_INPUT: an open edge"), std::string::npos) << failed.err;
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

TEST_F(ClientTest, LogPrintsALineForEachEventAndAnObjectUnderJson) {
  v1::JobEvent& submitted = *service_.events.add_events();
  submitted.set_number(1);
  submitted.set_event("submitted");
  v1::JobEvent& leased = *service_.events.add_events();
  leased.set_number(2);
  leased.set_event("leased");
  leased.set_worker("w\n1");
  const Outcome outcome = run({"log", "@last"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2) << outcome.out;
  std::istringstream lines(run({"--json", "log", "@last"}).out);
  std::vector<json> events;
  for (std::string line; std::getline(lines, line);) events.push_back(json::parse(line));
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].at("event"), "submitted");
  EXPECT_EQ(events[1].at("number"), 2);
  EXPECT_EQ(events[1].at("worker"), "w\n1");
  service_.fails = {grpc::StatusCode::NOT_FOUND, "no job begins with 000000"};
  EXPECT_EQ(run({"log", "000000"}).exit_code, 4);
}

}  // namespace
}  // namespace affskel::client
