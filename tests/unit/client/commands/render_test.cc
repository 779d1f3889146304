// The command render, against a server in this process.
#include <algorithm>
#include <string>
#include <vector>

#include "client_fixture.h"
#include "sample_data.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

TEST_F(ClientTest, RenderWritesAPng) {
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "p.png", "--width", "300"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "p.png").substr(1, 3), "PNG");
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "p.png", "--width", "3"}).exit_code, 2);
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "p.jpg"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "p.jpg"));
}

TEST_F(ClientTest, RenderTakesCamerasALevelABackgroundAndAnAxisUp) {
  const auto picture = [&](std::vector<std::string> options) {
    std::vector<std::string> command = {"render", "@last", "-o", dir_ / "p.png", "--width", "300"};
    command.insert(command.end(), options.begin(), options.end());
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return tests::read_file(dir_ / "p.png");
  };
  const std::string plain = picture({});
  EXPECT_EQ(plain, picture({"--camera", "front", "--camera", "side", "--camera", "top", "--up", "z"}));
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--camera", "30,20"},
                                                  {"--no-mesh"},
                                                  {"--background", "#102030"},
                                                  {"--up", "y"}})
    EXPECT_NE(plain, picture(options)) << options[0];
  service_.fetches.clear();
  EXPECT_NE(plain, picture({"--level", "5%"}));
  const auto asked = std::find_if(service_.fetches.begin(), service_.fetches.end(), [](const auto& request) {
    return request.kind() == v1::ARTIFACT_KIND_ERODED_SURFACE;
  });
  ASSERT_NE(asked, service_.fetches.end());
  EXPECT_EQ(asked->eroded().fraction(), 0.05);
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--camera", "north"},
                                                {"--camera", "0,95"},
                                                {"--background", "red"},
                                                {"--level", "1.5"},
                                                {"--up", "up"},
                                                {"--up", "y,-y"}}) {
    std::vector<std::string> command = {"render", "@last", "-o", dir_ / "w.png"};
    command.insert(command.end(), wrong.begin(), wrong.end());
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 2) << wrong[0] << " " << wrong[1];
    EXPECT_NE(outcome.err.find(wrong[1]), std::string::npos) << outcome.err;
  }
  EXPECT_FALSE(std::filesystem::exists(dir_ / "w.png"));
}

TEST_F(ClientTest, RenderAndViewKeepHowTheSolidStands) {
  const std::string one = dir_ / "p.png", other = dir_ / "q.png";
  ASSERT_EQ(run({"render", "@last", "-o", one, "--width", "300", "--up", "y,-x"}).exit_code, 0);
  EXPECT_EQ(service_.job.stance().up(), v1::AXIS_DIRECTION_Y);
  EXPECT_EQ(service_.job.stance().front(), v1::AXIS_DIRECTION_MINUS_X);
  EXPECT_NE(run({"status", "@last"}).out.find("y up, facing -x"), std::string::npos);
  ASSERT_EQ(run({"render", "@last", "-o", other, "--width", "300"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(one), tests::read_file(other));
  ASSERT_EQ(run({"view", "@last", "-o", dir_ / "v.html", "--up", "shape"}).exit_code, 0);
  EXPECT_FALSE(service_.job.has_stance());
  for (const char* command : {"render", "view"})
    EXPECT_EQ(
        run({command, "@last", "-o", command == std::string("view") ? other + ".html" : other, "--up", ""})
            .exit_code,
        2);
}

TEST_F(ClientTest, RenderDrawsTheSkeletonThatIsAskedFor) {
  const std::string plain = dir_ / "p.png", other = dir_ / "q.png";
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_SOBEL);
  ASSERT_EQ(run({"render", "@last", "-o", plain, "--width", "300"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.front().skeleton().operator_(), v1::OPERATOR_SOBEL) << "the job's own";
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

TEST_F(ClientTest, AllShowTheSkeletonOfTheJob) {
  for (const v1::Operator which : {v1::OPERATOR_RIDGE, v1::OPERATOR_FLUX}) {
    service_.job.mutable_skeleton()->set_operator_(which);
    const v1::ArtifactKind kind =
        which == v1::OPERATOR_RIDGE ? v1::ARTIFACT_KIND_SURFACE : v1::ARTIFACT_KIND_SKELETON;
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"render", "@last", "-o", dir_ / "p.png", "--width", "300"},
          {"view", "@last", "-o", dir_ / "p.html"},
          {"skeleton", "@last", "-o", dir_ / "p.ply"},
          {"fetch", "@last", "skeleton", "-o", dir_ / "p.vtp"}}) {
      service_.fetches.clear();
      ASSERT_EQ(run(command).exit_code, 0) << command[0];
      const auto& asked = service_.fetches;
      EXPECT_TRUE(std::any_of(asked.begin(), asked.end(), [&](const v1::FetchArtifactRequest& request) {
        const v1::SkeletonParams& params =
            request.has_surface() ? request.surface().skeleton() : request.skeleton();
        return params.operator_() == which && (command[0] == "view" || request.kind() == kind);
      })) << command[0];
    }
  }
}

// As the centre of a ball: every command that shows it says the same.
TEST_F(ClientTest, ASkeletonThatIsAPointIsNotEmpty) {
  v1::TriangleMesh point;
  for (const double v : {1., 2., 3.}) point.add_xyz(v);
  for (auto* values : {point.mutable_erosion(), point.mutable_strength(), point.mutable_area()})
    values->Add(4);
  point.mutable_quality()->set_advice("it is hardly more than a point.");
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = point.SerializeAsString();
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_RIDGE);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"render", "@last", "-o", dir_ / "p.png", "--width", "300"},
        {"skeleton", "@last", "-o", dir_ / "p.vtp"},
        {"surface", "@last", "-o", dir_ / "p.off"},
        {"fetch", "@last", "curve", "-o", dir_ / "p.ply"}}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("the skeleton: it is hardly more than a point."), std::string::npos)
        << outcome.err;
    EXPECT_EQ(outcome.err.find("empty"), std::string::npos) << outcome.err;
    const bool counted = outcome.err.find(", 1 point)") != std::string::npos;
    EXPECT_EQ(counted, command[0] != "render") << outcome.err;
  }
  const Outcome drawn = run({"--json", "render", "@last", "-o", dir_ / "p.png", "--width", "300"});
  EXPECT_NE(drawn.out.find("\"1 point (ridge"), std::string::npos) << drawn.out;
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

}  // namespace
}  // namespace affskel::client
