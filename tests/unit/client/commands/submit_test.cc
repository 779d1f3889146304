// `submit`, against a server in this process.
#include "client/commands/run_client.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "client_fixture.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/text/off_file.h"
#include "test_environment.h"
#include "tools/files.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

using nlohmann::json;

TEST_F(ClientTest, SubmitSendsTheFileAndPrintsTheIdAlone) {
  const Outcome done = run({"submit", dir_ / "cube.off", "--spacing", "200", "--frame", "affine",
                            "--directions", "triangles+sphere:20", "--priority", "7", "--request-id", "k1",
                            "--threshold", "5", "--repair", "none"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, service_.job.id() + "\n");
  EXPECT_EQ(service_.mesh, mesh_);
  const v1::SubmitJobHeader& header = service_.submitted;
  EXPECT_EQ(header.mesh_sha256(), wire::sha256_hex(mesh_));
  EXPECT_EQ(header.mesh_bytes(), mesh_.size());
  EXPECT_EQ(header.name(), "cube");
  EXPECT_FALSE(header.owner().empty());
  EXPECT_EQ(header.priority(), 7u);
  EXPECT_EQ(header.request_id(), "k1");
  EXPECT_EQ(header.params().sampling().spacing(), 200);
  EXPECT_EQ(header.params().directions(), "triangles+sphere:20");
  EXPECT_EQ(header.params().frame(), v1::FRAME_AFFINE);
  EXPECT_EQ(header.params().minimum(), v1::MINIMUM_SET);
  EXPECT_FALSE(header.params().repair());
  EXPECT_EQ(header.skeleton().threshold(), 5);
  EXPECT_EQ(header.skeleton().operator_(), v1::OPERATOR_RIDGE);
}

TEST_F(ClientTest, AJobHasTheNameOfItsFileWithoutControlCharacters) {
  tests::write_file(dir_ / "two\nlines\x1b[2J.off", mesh_);
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--name", ""}}) {
    std::vector<std::string> command = {"submit", dir_ / "two\nlines\x1b[2J.off"};
    command.insert(command.end(), more.begin(), more.end());
    EXPECT_EQ(run(command).exit_code, 0);
    EXPECT_EQ(service_.submitted.name(), "two lines?[2J");
  }
}

// Nobody can make files in /sys.
TEST_F(ClientTest, SubmitFindsOutFirstWhetherItsFolderCanBeWritten) {
  const Outcome refused = run({"submit", dir_ / "cube.off", "-o", "/sys"});
  EXPECT_EQ(refused.exit_code, 7);
  EXPECT_EQ(refused.out, "");
  EXPECT_NE(refused.err.find("/sys/cube.field.vti: cannot write: "), std::string::npos) << refused.err;
  EXPECT_EQ(service_.submitted.mesh_bytes(), 0u);
}

TEST_F(ClientTest, SubmitFindsOutFirstWhetherItsFilesCanHaveTheirNames) {
  const std::string longest = std::string(251, 'x') + ".off";
  std::filesystem::copy_file(dir_ / "cube.off", dir_ / longest);
  std::filesystem::create_directories(dir_ / "taken/cube.skeleton.ply");
  for (const auto& [file, folder, why] :
       {std::array{longest, std::string("out"), std::string("File name too long")},
        std::array{std::string("cube.off"), std::string("taken"),
                   std::string("cube.skeleton.ply: cannot write: Is a directory")}}) {
    const Outcome refused = run({"submit", dir_ / file, "-o", dir_ / folder});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find(why), std::string::npos) << refused.err;
    EXPECT_EQ(service_.submitted.mesh_bytes(), 0u);
  }
}

TEST_F(ClientTest, WhatIsRefusedLeavesNoFolder) {
  EXPECT_EQ(run({"submit", dir_ / "cube.off", "-o", dir_ / "new/deep"}, "unix:/nowhere/s").exit_code, 5);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "new"));
  std::filesystem::copy_file(dir_ / "cube.off", dir_ / (std::string(251, 'x') + ".off"));
  EXPECT_EQ(run({"submit", dir_ / (std::string(251, 'x') + ".off"), "-o", dir_ / "new/"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "new"));
  std::filesystem::create_directory(dir_ / "mine");
  EXPECT_EQ(run({"submit", dir_ / "cube.off", "-o", dir_ / "mine/deep"}, "unix:/nowhere/s").exit_code, 5);
  EXPECT_TRUE(std::filesystem::is_empty(dir_ / "mine"));
}

TEST_F(ClientTest, SubmitTakesNoEmptyNames) {
  for (const auto& [arguments, name] :
       {std::pair{std::vector<std::string>{"submit", dir_ / "cube.off", "-o", ""},
                  "--output-dir: must not be empty"},
        std::pair{std::vector<std::string>{"submit", ""}, "FILE: must not be empty"}}) {
    const Outcome refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find(name), std::string::npos) << refused.err;
  }
  EXPECT_EQ(service_.submitted.mesh_bytes(), 0u);
}

TEST_F(ClientTest, AnIdThatCannotBePrintedIsToldWithTheReason) {
  for (const bool as_json : {false, true}) {
    std::ofstream full("/dev/full");
    std::ostringstream err;
    std::vector<std::string> arguments = {"--server", server_.address(), "submit", dir_ / "cube.off"};
    if (as_json) arguments.insert(arguments.begin(), "--json");
    const ClientIo io{full, err, false, test_environment({{"HOME", dir_.path()}}), {}};
    EXPECT_EQ(run_client(arguments, io), 8);
    EXPECT_NE(err.str().find("; job " + service_.job.id() + " was submitted"), std::string::npos)
        << err.str();
  }
}

TEST_F(ClientTest, SubmitAsksForTheInfimum) {
  EXPECT_EQ(run({"submit", dir_ / "cube.off", "--minimum", "infimum"}).exit_code, 0);
  EXPECT_EQ(service_.submitted.params().minimum(), v1::MINIMUM_INFIMUM);
  const Outcome wrong = run({"submit", dir_ / "cube.off", "--minimum", "infinum"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("infimum"), std::string::npos) << wrong.err;
}

// A cube of 2000 units, with a spacing in another unit: told before anything is sent, and before its directions.
TEST_F(ClientTest, SubmitRefusesASpacingThatLeavesNoPoints) {
  const Outcome outcome = run({"submit", dir_ / "cube.off", "--spacing", "1001"}, "unix:/nowhere/s");
  EXPECT_EQ(outcome.exit_code, 3);
  for (const char* part : {"cube.off: the spacing 1001 leaves no room",
                           "2000 x 2000 x 2000 units, the size of a person in millimetres",
                           "a spacing of 43 gives 100000 points"})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << "\n" << outcome.err;
  EXPECT_EQ(outcome.err.find("directions"), std::string::npos) << outcome.err;
  EXPECT_EQ(run({"submit", dir_ / "cube.off", "--spacing", "1000"}, "unix:/nowhere/s").exit_code, 5);
}

TEST_F(ClientTest, ASpacingMayBeAShareOfTheMeshsLength) {
  const Outcome outcome = run({"submit", dir_ / "cube.off", "--spacing", "2.5%"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(service_.submitted.params().sampling().spacing(), 50);
  EXPECT_NE(outcome.err.find("spacing 50\n"), std::string::npos) << outcome.err;
  for (const char* wrong : {"0%", "100%", "-1%", "%", "x%"})
    EXPECT_EQ(run({"submit", dir_ / "cube.off", "--spacing", wrong}).exit_code, 2) << wrong;
  EXPECT_EQ(run({"submit", dir_ / "cube.off", "--spacing", "60%"}).exit_code, 3) << "no room for points";
}

// Nothing is sent: there is no server.
TEST_F(ClientTest, SubmitRefusesWhatIsBeyondTheCoresLimits) {
  const std::string file = dir_ / "cube.off", nowhere = "unix:/nowhere/s";
  for (const char* frame : {"axis", "affine"}) {
    const Outcome fine = run({"submit", file, "--spacing", "1e-9", "--frame", frame}, nowhere);
    EXPECT_EQ(fine.exit_code, 8);
    EXPECT_EQ(fine.out, "");
    for (const char* part :
         {"cube.off: spacing 1e-09 would give about ", " sample points on ", " lattice lines; ",
          "at most 2.15e+09 points on 4e+08 lines", "take a spacing of "}) {
      EXPECT_NE(fine.err.find(part), std::string::npos) << part << "\n" << fine.err;
    }
  }
  const Outcome many = run({"submit", file, "--directions", "triangles+sphere:16777205"}, nowhere);
  EXPECT_EQ(many.exit_code, 8);
  EXPECT_NE(many.err.find(
                "cube.off: directions 'triangles+sphere:16777205': 16777217 directions; at most 16777216"),
            std::string::npos)
      << many.err;
  const Outcome as_json = run({"--json", "submit", file, "--spacing", "1e-300"}, nowhere);
  EXPECT_EQ(as_json.exit_code, 8);
  const json error = json::parse(as_json.err).at("error");
  EXPECT_EQ(error.at("code"), "LIMIT");
  EXPECT_EQ(error.at("file"), file);
  EXPECT_TRUE(
      error.at("message").get<std::string>().starts_with("spacing 1e-300 would give more than 1e+308"));
}

TEST_F(ClientTest, SubmitSendsWhatIsWithinTheCoresLimits) {
  const std::string file = dir_ / "cube.off";
  const std::string refusal = run({"submit", file, "--spacing", "1e-9"}).err;
  EXPECT_EQ(service_.submitted.mesh_bytes(), 0u);
  const std::string before = "take a spacing of ";
  std::string least = refusal.substr(refusal.find(before) + before.size());
  least.resize(least.find(' '));
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--spacing", least},
                                                  {"--spacing", least, "--frame", "obb"},
                                                  {"--points", "2147483648"},
                                                  {"--directions", "triangles+sphere:16777204"}}) {
    std::vector<std::string> arguments = {"submit", file};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome sent = run(arguments);
    EXPECT_EQ(sent.exit_code, 0) << sent.err;
  }
}

TEST_F(ClientTest, SubmitAimsAtAHundredThousandPointsByDefault) {
  EXPECT_EQ(run({"submit", dir_ / "cube.off"}).exit_code, 0);
  EXPECT_EQ(service_.submitted.params().sampling().target_points(), 100000u);
  EXPECT_EQ(service_.submitted.params().frame(), v1::FRAME_AXIS);
  EXPECT_EQ(service_.submitted.priority(), 5u);
  EXPECT_TRUE(service_.submitted.params().repair());
}

// Unasked, what bounds no solid is repaired and told of, or refused with the command that would do it.
TEST_F(ClientTest, SubmitRepairsWhatBoundsNoSolid) {
  core::Mesh cube = core::make_box(2000, 2000, 2000, 8);
  cube.triangles.erase(cube.triangles.begin(), cube.triangles.begin() + 2);
  tests::write_file(dir_ / "hole.off", core::write_off(cube));
  const Outcome done = run({"--json", "submit", dir_ / "hole.off", "--spacing", "200"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.err.find("repaired before it was sent: 1 hole filled"), std::string::npos) << done.err;
  EXPECT_EQ(json::parse(done.out).at("repaired")[0].at("code"), "filled-holes");
  EXPECT_EQ(service_.source, core::write_off(cube));
  EXPECT_EQ(service_.submitted.repair().steps(0).code(), "filled-holes");
  const core::OffMesh sent = core::read_off(service_.mesh);
  EXPECT_NEAR(core::make_solid(sent.mesh).volume, 8e9, 8e5);
  EXPECT_EQ(run({"submit", dir_ / "hole.off", "--repair", "none"}, "unix:/nowhere/s").exit_code, 3);

  // Half of it is too much.
  cube.triangles.resize(cube.triangles.size() / 2);
  tests::write_file(dir_ / "half.off", core::write_off(cube));
  const Outcome refused = run({"submit", dir_ / "half.off"}, "unix:/nowhere/s");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("repair " + std::string(dir_ / "half.off") + " --repair fill="),
            std::string::npos)
      << refused.err;
}

TEST_F(ClientTest, SubmitRefusesBadMeshesWithoutTheServer) {
  const Outcome malformed = run({"--json", "submit", dir_ / "bad.off"}, "unix:/nowhere/s");
  EXPECT_EQ(malformed.exit_code, 3);
  EXPECT_EQ(malformed.out, "");
  const json error = json::parse(malformed.err).at("error");
  EXPECT_EQ(error.at("code"), "BAD_INPUT");
  EXPECT_EQ(error.at("file"), dir_ / "bad.off");
  EXPECT_EQ(error.at("line"), 5);
  EXPECT_EQ(run({"submit", dir_ / "open.off"}, "unix:/nowhere/s").exit_code, 3);
  EXPECT_EQ(run({"submit", dir_ / "missing.off"}, "unix:/nowhere/s").exit_code, 3);
  EXPECT_EQ(run({"submit", dir_.path()}, "unix:/nowhere/s").exit_code, 3);
}

TEST_F(ClientTest, TextForTheServerMustBeUtf8) {
  const std::string bad = "k\xFF";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"submit", dir_ / "cube.off", "--name", bad},
        {"submit", dir_ / "cube.off", "--request-id", bad},
        {"list", "--owner", bad},
        {"status", bad}}) {
    const Outcome refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("UTF-8"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(service_.mesh, "");
}

TEST_F(ClientTest, SubmitKeepsToTheServersLimit) {
  service_.max_mesh_bytes = 10;
  const Outcome outcome = run({"submit", dir_ / "cube.off"});
  EXPECT_EQ(outcome.exit_code, 8);
  EXPECT_EQ(service_.mesh, "");
}

TEST_F(ClientTest, SubmitIntoADirectoryWritesAllThree) {
  const Outcome done = run({"--json", "submit", dir_ / "cube.off", "-o", dir_ / "OUT/deep"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const json document = json::parse(done.out);
  EXPECT_EQ(document.at("id"), service_.job.id());
  EXPECT_EQ(document.at("files").at("field"), dir_ / "OUT/deep/cube.field.vti");
  EXPECT_TRUE(std::filesystem::exists(dir_ / "OUT/deep/cube.field.vti"));
  EXPECT_EQ(tests::read_file(dir_ / "OUT/deep/cube.skeleton.ply").substr(0, 4), "ply\n");
  EXPECT_NE(tests::read_file(dir_ / "OUT/deep/cube.skeleton.vtp").find("PolyData"), std::string::npos);
  EXPECT_EQ(document.at("files").at("skeleton"),
            json({dir_ / "OUT/deep/cube.skeleton.vtp", dir_ / "OUT/deep/cube.skeleton.ply"}));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(dir_ / "OUT/deep")) ++files;
  EXPECT_EQ(files, 3u);
}

TEST_F(ClientTest, OtherFormatsAreSubmittedAsOffText) {
  ASSERT_EQ(run({"transform", dir_ / "cube.off", "-o", dir_ / "cube.stl", "--scale", "1"}).exit_code, 0);
  const Outcome submitted = run({"submit", dir_ / "cube.stl"});
  EXPECT_EQ(submitted.exit_code, 0) << submitted.err;
  EXPECT_NE(
      submitted.err.find("cube.stl: read as stl, 8 vertices and 12 triangles; what is sent is OFF text"),
      std::string::npos)
      << submitted.err;
  EXPECT_EQ(core::read_off(service_.mesh).mesh.points.size(), 8u);
  EXPECT_EQ(service_.submitted.mesh_sha256(), wire::sha256_hex(service_.mesh));
  EXPECT_EQ(service_.submitted.mesh_bytes(), service_.mesh.size());
  EXPECT_EQ(service_.submitted.name(), "cube");
  const json facts = json::parse(run({"--json", "inspect", dir_ / "cube.stl"}).out);
  EXPECT_EQ(facts.at("format"), "stl");
  EXPECT_EQ(facts.at("bytes"), 84 + 12 * 50);
  EXPECT_EQ(facts.at("submitted_bytes"), service_.mesh.size());
  EXPECT_EQ(facts.at("submitted_sha256"), service_.submitted.mesh_sha256());
  EXPECT_EQ(facts.at("volume"), 8e9);
}

}  // namespace
}  // namespace affskel::client
