// The command fetch, against a server in this process.
#include <nlohmann/json.hpp>
#include <string>
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

// That of the job, where its operator is the curve.
TEST_F(ClientTest, TheCurveIsFetchedByItsThreshold) {
  const auto threshold = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"fetch", "@last", "curve", "-o", dir_ / "c.vtp"});
    run(more);
    return service_.fetches.back().surface().skeleton().threshold();
  };
  EXPECT_EQ(threshold({"--threshold", "3"}), 3);
  service_.job.mutable_skeleton()->set_threshold(5);
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  EXPECT_EQ(threshold({}), 0);
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  EXPECT_EQ(threshold({}), 5);
  EXPECT_EQ(threshold({"--threshold", "2"}), 2);
  EXPECT_EQ(run({"fetch", "@last", "field", "--threshold", "2", "-o", dir_ / "f.csv"}).exit_code, 2);
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
    EXPECT_NE(outcome.err.find("cannot write, there is no folder /nowhere: No such file"), std::string::npos)
        << outcome.err;
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

TEST_F(ClientTest, DivergencesComeWithTheirPlaces) {
  EXPECT_EQ(run({"fetch", "@last", "divergence", "-o", dir_ / "H.csv"}).exit_code, 0);
  const std::string text = tests::read_file(dir_ / "H.csv");
  EXPECT_EQ(text.substr(0, 8), "x,y,z,H\n");
  EXPECT_NE(text.find(",-7.25\n"), std::string::npos) << text;
  EXPECT_EQ(service_.fetches.back().skeleton().operator_(), v1::OPERATOR_ZUCKER_HUMMEL)
      << "of a job with a sheet";
  EXPECT_EQ(run({"fetch", "@last", "divergence", "--operator", "sobel", "-o", dir_ / "H.dat"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().skeleton().operator_(), v1::OPERATOR_SOBEL);
  EXPECT_EQ(run({"fetch", "@last", "divergence", "-o", dir_ / "H.vtkhdf"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "H.vtkhdf").substr(1, 3), "HDF");
  const Outcome none = run({"fetch", "@last", "mesh", "--operator", "sobel", "-o", dir_ / "m.off"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_EQ(none.err.find("--help"), none.err.rfind("--help")) << none.err;
  service_.artifacts[v1::ARTIFACT_KIND_DIVERGENCE].resize(4 * 8);
  EXPECT_EQ(run({"fetch", "@last", "divergence", "-o", dir_ / "short.csv"}).exit_code, 70);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "short.csv"));
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

}  // namespace
}  // namespace affskel::client
