// The command `repair`, and what `submit` does of it.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "client/text/key_line.h"
#include "client_fixture.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/solid/surface_samples.h"
#include "core/text/off_file.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

core::Mesh overlapping_cubes() {
  core::Mesh two = core::make_box(2000, 2000, 2000, 2);
  const auto second = static_cast<std::uint32_t>(two.points.size());
  const core::Mesh one = two;
  for (const core::Vec3& place : one.points) two.points.push_back(place + core::Vec3{990, 970, 1030});
  for (const core::Triangle& t : one.triangles)
    two.triangles.push_back({second + t[0], second + t[1], second + t[2]});
  return two;
}

TEST_F(ClientTest, RepairNeedsNoServerAndTellsEachStep) {
  core::Mesh cube = core::make_box(2000, 2000, 2000, 2);
  cube.triangles.pop_back();
  tests::write_file(dir_ / "open.off", core::write_off(cube));
  const Outcome closed =
      run({"--json", "repair", dir_ / "open.off", "--repair", "fill=1e6", "-o", dir_ / "closed.off"},
          "unix:/nowhere/s");
  ASSERT_EQ(closed.exit_code, 0) << closed.err;
  EXPECT_EQ(json::parse(closed.out).at("steps").at(0).at("code"), "filled-holes");
  EXPECT_EQ(json::parse(closed.out).at("volume"), 8e9);
  EXPECT_EQ(run({"inspect", dir_ / "closed.off"}).exit_code, 0);
  const Outcome sound = run({"repair", dir_ / "cube.off", "-o", dir_ / "same.ply"});
  EXPECT_NE(sound.out.find("sound:"), std::string::npos) << sound.out;

  // Two cubes that overlap: told, not mended.
  tests::write_file(dir_ / "two.off", core::write_off(overlapping_cubes()));
  const Outcome crossing = run({"--json", "repair", dir_ / "two.off", "-o", dir_ / "two.ply"});
  EXPECT_EQ(crossing.exit_code, 0);
  EXPECT_EQ(json::parse(crossing.out).at("warnings").at(0).at("code"), "self-intersecting");
  EXPECT_NE(crossing.err.find("try --repair wrap"), std::string::npos) << crossing.err;
  EXPECT_EQ(run({"repair", dir_ / "two.off", "-o", dir_ / "two.ply"}).out.find("sound:"), std::string::npos);

  const Outcome piped =
      run({"repair", dir_ / "open.off", "--repair", "fill=1e6", "-o", "-", "--format", "off"});
  EXPECT_EQ(piped.exit_code, 0);
  EXPECT_EQ(piped.out, "") << "the report is not in the file";
  EXPECT_NE(piped.err.find("1 hole filled"), std::string::npos) << piped.err;

  // Submitted as it is then.
  const Outcome submitted = run({"submit", dir_ / "open.off", "--repair", "fill=1e6", "--points", "100"});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  EXPECT_NE(submitted.err.find("repaired before it was sent: 1 hole filled"), std::string::npos)
      << submitted.err;
  EXPECT_EQ(core::read_off(service_.mesh).mesh.triangles.size(), 48u);
  EXPECT_EQ(run({"submit", dir_ / "open.off", "--repair", "mend"}).exit_code, 2);

  // What was not done is told with commands that do it.
  const Outcome left = run({"repair", dir_ / "open.off", "--repair", "fill=10", "-o", dir_ / "left.off"});
  EXPECT_EQ(left.exit_code, 3);
  EXPECT_NE(left.err.find("1 hole is left"), std::string::npos) << left.err;
  EXPECT_NE(left.err.find("--repair fill="), std::string::npos) << left.err;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "left.off"));
  EXPECT_EQ(run({"repair", dir_ / "open.off", "--repair", "none", "-o", dir_ / "left.off"}).exit_code, 3);
  EXPECT_EQ(run({"repair", dir_ / "cube.off", "--repair", "wrap=500", "-o", dir_ / "wrapped.stl"}).exit_code,
            0);
  EXPECT_NE(run({"repair", "--help"}).out.find("wrap=ALPHA, fill=LENGTH (default"), std::string::npos);
  for (const char* wrong : {"mend", "fill=", "fill=-1", "wrap=x", "none=3"})
    EXPECT_EQ(run({"repair", dir_ / "cube.off", "--repair", wrong, "-o", dir_ / "w.off"}).exit_code, 2)
        << wrong;
}

// Too narrow for the ball: the volume is another.
TEST_F(ClientTest, CavitiesThatAWrapClosesAreWarnedOf) {
  core::Mesh hollow = core::make_box(2000, 2000, 2000);
  const core::Mesh cavity = core::make_box(1200, 1200, 1200);
  const auto first = static_cast<std::uint32_t>(hollow.points.size());
  for (const core::Vec3& place : cavity.points) hollow.points.push_back(place + core::Vec3{400, 400, 400});
  for (const auto& [a, b, c] : cavity.triangles)
    hollow.triangles.push_back({first + a, first + c, first + b});
  tests::write_file(dir_ / "hollow.off", core::write_off(hollow));
  const Outcome closed =
      run({"--json", "repair", dir_ / "hollow.off", "--repair", "wrap=700", "-o", dir_ / "closed.off"});
  ASSERT_EQ(closed.exit_code, 0) << closed.err;
  const json warnings = json::parse(closed.out).at("warnings");
  ASSERT_EQ(warnings.size(), 2U) << warnings;
  EXPECT_EQ(warnings[0].at("code"), "closed-cavities");
  EXPECT_EQ(warnings[1].at("code"), "wrap-volume");
  const Outcome submitted = run({"submit", dir_ / "hollow.off", "--repair", "wrap=700"});
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  EXPECT_NE(submitted.err.find("warning: "), std::string::npos) << submitted.err;
  EXPECT_NE(submitted.err.find("1 cavity closed"), std::string::npos) << submitted.err;
  const v1::MeshRepair& told = service_.submitted.repair();
  ASSERT_EQ(told.steps_size(), 3);
  EXPECT_EQ(told.steps(0).severity(), "repaired");
  EXPECT_EQ(told.steps(1).severity(), "warning");
  *service_.job.mutable_repair() = told;
  const Outcome status = run({"status", service_.job.id()});
  EXPECT_NE(status.out.find(key_line("warning", "closed-cavities: 1 cavity closed").substr(0, 40)),
            std::string::npos)
      << status.out;
  const std::string said = run({"submit", dir_ / "hollow.off", "--repair", "wrap=700", "--wait"}).err;
  EXPECT_EQ(said.find("1 cavity closed"), said.rfind("1 cavity closed")) << "once: " << said;
  EXPECT_EQ(run({"repair", dir_ / "hollow.off", "--repair", "wrap=400", "-o", dir_ / "kept.off"})
                .err.find("cavity closed"),
            std::string::npos);
}

// The worker's has lines of the file that was sent, the client's none.
TEST_F(ClientTest, AWarningOfWhatWasRepairedIsTheJobsToo) {
  core::Mesh open = overlapping_cubes();
  open.triangles.pop_back();
  tests::write_file(dir_ / "two.off", core::write_off(open));
  v1::MeshNote& note = *service_.job.mutable_prepared()->add_notes();
  note.set_severity("warning");
  note.set_code("self-intersecting");
  note.set_message("3 pairs of triangles cross or touch each other, the first: triangle 1 (line 9)");
  const std::string said = run({"submit", dir_ / "two.off", "--repair", "fill=1e6", "--wait"}).err;
  EXPECT_NE(said.find("cross or touch"), std::string::npos) << said;
  EXPECT_EQ(said.find("cross or touch"), said.rfind("cross or touch")) << said;
}

TEST_F(ClientTest, CloudsOfPointsAreWrappedWhenAsked) {
  std::string text;
  for (const core::Vec3& p : core::surface_samples(core::make_sphere(10, 1280), 2000))
    text += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
  tests::write_file(dir_ / "ball.xyz", text);
  const Outcome refused = run({"submit", dir_ / "ball.xyz"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("--repair wrap"), std::string::npos) << refused.err;
  EXPECT_NE(run({"inspect", dir_ / "ball.xyz"}).err.find("--repair wrap"), std::string::npos);
  const Outcome wrapped = run({"submit", dir_ / "ball.xyz", "--repair", "wrap=1"});
  EXPECT_EQ(wrapped.exit_code, 0) << wrapped.err;
  EXPECT_NE(wrapped.err.find("a surface laid through 2000 points"), std::string::npos) << wrapped.err;
  EXPECT_NEAR(core::make_solid(core::read_off(service_.mesh).mesh).volume, 4e3 / 3 * M_PI, 100);
}

}  // namespace
}  // namespace affskel::client
