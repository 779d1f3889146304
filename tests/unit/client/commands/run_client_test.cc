// The client from its arguments to its exit code, against a server in this process.
#include "client/commands/run_client.h"

#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "client/files/read/input_file.h"
#include "client_fixture.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "test_environment.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

TEST_F(ClientTest, FileNamesMayHoldAnyBytes) {
  const std::string stem("c\xFF_e");
  tests::write_file(dir_ / (stem + ".off"), mesh_);
  const Outcome done = run({"submit", dir_ / (stem + ".off"), "-o", dir_ / "OUT"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(service_.submitted.name(), "c\xEF\xBF\xBD_e");
  EXPECT_TRUE(std::filesystem::exists(dir_ / ("OUT/" + stem + ".field.vti")));
}

TEST_F(ClientTest, AMisspeltCommandIsNamed) {
  EXPECT_NE(run({"statsu", "@last"}).err.find("no command 'statsu'"), std::string::npos);
  EXPECT_NE(run({"make", "cuboid", "-o", dir_ / "x.off"}).err.find("no shape 'cuboid'"), std::string::npos);
  EXPECT_NE(run({"make", "blob"}).err.find("make knows torus, sphere,"), std::string::npos);
  EXPECT_NE(run({"make"}).err.find("no shape was given"), std::string::npos);
  EXPECT_NE(run({}).err.find("no command was given"), std::string::npos);
}

TEST_F(ClientTest, SaysHowManyThereMayBe) {
  const Outcome refused = run({"view", "@last", "@last", "@last", "-o", dir_ / "x.html"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("JOB: at most 2, not 3; see affskel-client view --help"), std::string::npos)
      << refused.err;
  const Outcome few = run({"make", "box", "--size", "1,2", "-o", dir_ / "x.off"});
  EXPECT_NE(few.err.find("--size: at least 3, not 2;"), std::string::npos) << few.err;
}

TEST_F(ClientTest, WordsTooManyAreToldInTheirOrderAndNotByTheThousand) {
  const auto said = [&](const std::vector<std::string>& words) {
    std::vector<std::string> arguments = {"status"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    return run(arguments).err;
  };
  EXPECT_NE(said({"A", "B", "C"}).find("not expected: B C; see"), std::string::npos) << said({"A", "B", "C"});
  EXPECT_NE(said({"A", "A"}).find("not expected: A; see"), std::string::npos);
  EXPECT_NE(said({"A", "B", "C", "D", "E", "F"}).find("not expected: B C D and 2 more; see"),
            std::string::npos);
}

TEST_F(ClientTest, MemoryIsAWholeNumberOfBytesWithOrWithoutAUnit) {
  const auto inspect = [&](const std::string& memory) {
    return run({"--memory", memory, "inspect", dir_ / "cube.off"});
  };
  for (const char* good : {"0", "4294967296", "4194304K", "4096M", "4G"})
    EXPECT_EQ(inspect(good).exit_code, 0) << good;
  for (const char* wrong : {"-1", "1.5G", "2X", "2T", "2GB", "", "K", "17179869184G"}) {
    const Outcome refused = inspect(wrong);
    EXPECT_EQ(refused.exit_code, 2) << wrong;
    EXPECT_NE(refused.err.find(
                  "--memory: must be a whole number of bytes, or one with K, M or G for powers of 1024 "
                  "behind it, not '" +
                  std::string(wrong) + "'"),
              std::string::npos)
        << refused.err;
  }
}

TEST_F(ClientTest, AMeshWhereAJobIsWantedIsToldToBeSubmitted) {
  for (const char* command : {"render", "view", "status"}) {
    const Outcome refused = run({command, dir_ / "cube.off"});
    EXPECT_EQ(refused.exit_code, 2) << command;
    EXPECT_NE(refused.err.find("is a file, not a job; submit it first: affskel-client submit"),
              std::string::npos)
        << refused.err;
  }
}

TEST_F(ClientTest, WaitEndsWithTheJobsState) {
  EXPECT_EQ(run({"submit", dir_ / "cube.off", "--wait"}).exit_code, 0);
  service_.watch.back() = sample_job(v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(run({"submit", dir_ / "cube.off", "--wait"}).exit_code, 6);
  service_.watch.back() = sample_job(v1::JOB_STATE_FAILED);
  service_.watch.back().mutable_error()->set_code("WORKER_LOST");
  service_.watch.back().mutable_error()->set_message("lost 5 workers");
  const Outcome failed = run({"submit", dir_ / "cube.off", "-w"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.out, service_.job.id() + "\n");
  EXPECT_NE(failed.err.find("WORKER_LOST: lost 5 workers"), std::string::npos);
}

TEST_F(ClientTest, AnEmptySkeletonIsAWarning) {
  service_.watch.back().set_skeleton_points(0);
  const Outcome done = run({"watch", "@last"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_NE(done.err.find("warning: the skeleton is empty"), std::string::npos);
  EXPECT_NE(done.err.find("smaller spacing"), std::string::npos) << done.err;
}

TEST_F(ClientTest, AnEmptySurfaceIsAWarning) {
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = "";
  const Outcome done = run({"surface", "@last", "-o", dir_ / "s.off"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_NE(done.err.find("warning: the surface is empty"), std::string::npos) << done.err;
}

TEST_F(ClientTest, AnEmptyAddressIsNotThePrivateServer) {
  std::ostringstream out, err;
  EXPECT_EQ(
      run_client({"--server", "", "list"}, {out, err, false, test_environment({{"HOME", dir_.path()}}), {}}),
      2);
  EXPECT_NE(err.str().find("--server"), std::string::npos) << err.str();
}

TEST_F(ClientTest, WatchReattachesWhenTheStreamBreaks) {
  service_.watch_breaks_after = 2;
  const Outcome done = run({"--json", "watch", "@last"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(service_.watches, 2);
  std::istringstream lines(done.out);
  std::vector<std::string> states;
  for (std::string line; std::getline(lines, line);) states.push_back(json::parse(line).at("state"));
  EXPECT_EQ(states, (std::vector<std::string>{"queued", "running", "queued", "running", "done"}));
}

TEST_F(ClientTest, WatchReattachesWhenTheStreamEndsTooEarly) {
  service_.watch_ends_after = 2;
  const Outcome done = run({"watch", "@last"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "done\n");
  EXPECT_NE(done.err.find("the server went away"), std::string::npos);
}

TEST_F(ClientTest, ABusyServerIsAskedAgain) {
  service_.busy = 2;
  const Outcome done = run({"status", "@last"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.err.find("trying again: too many calls"), std::string::npos) << done.err;
  EXPECT_LT(service_.busy, 0);
}

TEST_F(ClientTest, AServerThatClosesIsAskedAgain) {
  service_.busy = 2;
  service_.busy_status = {grpc::StatusCode::CANCELLED, "CANCELLED"};
  const Outcome done = run({"status", "@last"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
}

TEST_F(ClientTest, WatchGivesUpWhenTheServerStaysAway) {
  service_.watch_stays_away = true;
  service_.watch_breaks_after = 1;
  EXPECT_EQ(run({"watch", "@last"}).exit_code, 5);
  EXPECT_GT(service_.watches, 2);
}

TEST_F(ClientTest, WatchPrintsTheFinalState) {
  EXPECT_EQ(run({"watch", "@last"}).out, "done\n");
}

TEST_F(ClientTest, StatusTellsEveryFieldAsJson) {
  const Outcome outcome = run({"--json", "status", "@last"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1);
  const json job = json::parse(outcome.out);
  EXPECT_EQ(job.at("state"), "done");
  EXPECT_EQ(job.at("stage"), "complete");
  EXPECT_EQ(job.at("mesh_bytes"), std::uint64_t{1} << 53);
  EXPECT_EQ(job.at("counters").at("reports"), 3);
  EXPECT_EQ(job.at("counters").at("leases_lost"), 0);
  EXPECT_EQ(job.at("prepared").at("volume"), 8e9);
  EXPECT_EQ(job.size(), 28u) << "all fields but the absent messages params, error; got " << outcome.out;
}

TEST_F(ClientTest, StatusIsKeyValueLines) {
  const Outcome outcome = run({"status", "@last"});
  for (const char* line :
       {"job:                  0123456789abcdef0123456789abcdef\n", "state:                done\n",
        "directions:           12/12\n", "v0:                   8000000000\n", "spacing:              200\n",
        "points:               5\n"}) {
    EXPECT_NE(outcome.out.find(line), std::string::npos) << line << outcome.out;
  }
}

TEST_F(ClientTest, ListPassesFiltersOn) {
  const Outcome outcome =
      run({"list", "--state", "done", "--state", "failed", "--owner", "me", "--limit", "3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(service_.listed.states_size(), 2);
  EXPECT_EQ(service_.listed.states(1), v1::JOB_STATE_FAILED);
  EXPECT_EQ(service_.listed.owner(), "me");
  EXPECT_EQ(service_.listed.limit(), 3u);
  EXPECT_NE(outcome.out.find("0123456789ab  done"), std::string::npos) << outcome.out;
  service_.jobs = 1;
  EXPECT_EQ(json::parse(run({"--json", "list"}).out).at("jobs").size(), 1u);
}

TEST_F(ClientTest, ListFollowsPagesUpToItsLimit) {
  service_.jobs = 5000;
  EXPECT_EQ(json::parse(run({"--json", "list", "--limit", "2300"}).out).at("jobs").size(), 2300u);
  ASSERT_EQ(service_.lists.size(), 3u);
  EXPECT_EQ(service_.lists[0].page_token(), "");
  EXPECT_EQ(service_.lists[1].page_token(), "left 4000");
  EXPECT_EQ(service_.lists[2].page_token(), "left 3000");
  EXPECT_EQ(service_.lists[2].limit(), 300u);
  service_.jobs = 1200;
  EXPECT_EQ(json::parse(run({"--json", "list", "--limit", "9000"}).out).at("jobs").size(), 1200u);
}

TEST_F(ClientTest, ServerErrorsBecomeExitCodes) {
  EXPECT_EQ(run({"status", "000000"}).exit_code, 4);
  EXPECT_EQ(run({"list"}, "unix:/nowhere/s").exit_code, 5);
  service_.fails = {grpc::StatusCode::FAILED_PRECONDITION, "the job is done"};
  EXPECT_EQ(run({"resume", "@last"}).exit_code, 7);
  service_.fails = {grpc::StatusCode::RESOURCE_EXHAUSTED, "disk full"};
  EXPECT_EQ(run({"submit", dir_ / "cube.off"}).exit_code, 8);
  service_.fails = {grpc::StatusCode::ALREADY_EXISTS, "other content"};
  EXPECT_EQ(run({"submit", dir_ / "cube.off"}).exit_code, 2);
  service_.fails = {grpc::StatusCode::INTERNAL, "oops"};
  EXPECT_EQ(run({"delete", "@last"}).exit_code, 70);
}

TEST_F(ClientTest, JobCommandsPrintTheState) {
  EXPECT_EQ(run({"resume", "@last"}).out, "done\n");
  EXPECT_EQ(run({"pin", "@last"}).out, "pinned\n");
  EXPECT_TRUE(service_.job.pinned());
  EXPECT_EQ(run({"unpin", "@last"}).out, "unpinned\n");
  EXPECT_FALSE(service_.job.pinned());
  EXPECT_EQ(run({"delete", "@last"}).out, "deleted\n");
  service_.job = sample_job(v1::JOB_STATE_RUNNING);
  service_.job.set_cancel_requested(true);
  service_.watch = {service_.job, sample_job(v1::JOB_STATE_CANCELLED)};
  EXPECT_EQ(run({"cancel", "@last"}).out, "cancelled\n");
}

TEST_F(ClientTest, ServerInfo) {
  EXPECT_NE(run({"server-info"}).out.find("version:              9.8.7\n"), std::string::npos);
  EXPECT_EQ(json::parse(run({"--json", "server-info"}).out).at("workers").at(0).at("id"), "0123456789abcdef");
}

TEST_F(ClientTest, HealthIsWhatTheHealthServiceTells) {
  const Outcome serving = run({"health"});
  EXPECT_EQ(serving.out, "serving\n") << serving.err;
  EXPECT_EQ(serving.exit_code, 0);
  EXPECT_EQ(json::parse(run({"--json", "health"}).out).at("health"), "serving");
  server_.set_serving(false);
  const Outcome draining = run({"health"});
  EXPECT_EQ(draining.exit_code, 5);
  EXPECT_EQ(draining.out, "");
  EXPECT_NE(draining.err.find("is not serving"), std::string::npos) << draining.err;
  server_.set_serving(true);
  EXPECT_EQ(run({"health"}).exit_code, 0);
}

TEST_F(ClientTest, HealthOfAServerThatIsAwayIsToldAtOnce) {
  const Outcome away = run({"health"}, "unix:/nowhere/s");
  EXPECT_EQ(away.exit_code, 5);
  EXPECT_NE(away.err.find("unix:/nowhere/s"), std::string::npos) << away.err;
}

TEST_F(ClientTest, InspectNeedsNoServer) {
  const json facts = json::parse(run({"--json", "inspect", dir_ / "cube.off"}, "unix:/nowhere/s").out);
  EXPECT_EQ(facts.at("triangles"), 12);
  EXPECT_EQ(facts.at("genus"), 0);
  EXPECT_EQ(facts.at("volume"), 8e9);
  EXPECT_EQ(facts.at("solids"), 1);
  EXPECT_TRUE(facts.at("computable"));
  const Outcome open = run({"--json", "inspect", dir_ / "open.off"});
  EXPECT_EQ(open.exit_code, 3);
  EXPECT_FALSE(json::parse(open.out).at("computable"));
  EXPECT_EQ(json::parse(open.out).at("defects").at(0).at("count"), 3);
  EXPECT_EQ(json::parse(open.out).at("holes").at("count"), 1);
  EXPECT_EQ(json::parse(open.out).at("holes").at("longest").at(0).at("edges"), 3);
  EXPECT_NE(run({"inspect", dir_ / "open.off"}).out.find(" round, 3 edges, near ("), std::string::npos);
  EXPECT_EQ(run({"inspect", dir_ / "open.off", "--render", dir_ / "open.png"}).exit_code, 3);
  EXPECT_EQ(tests::read_file(dir_ / "open.png").substr(1, 3), "PNG");
  EXPECT_EQ(run({"inspect", dir_ / "cube.off", "--render", dir_ / "cube.png"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(dir_ / "cube.png"));
  EXPECT_EQ(run({"inspect", dir_ / "cube.off", "--render", dir_ / "cube.jpg"}).exit_code, 2);
}

TEST_F(ClientTest, MeshesInOtherFormatsFaceOutward) {
  core::Mesh cube = core::make_box(2000, 2000, 2000, 2);
  for (core::Triangle& t : cube.triangles) std::swap(t[0], t[1]);
  service_.artifacts[v1::ARTIFACT_KIND_MESH] = core::write_off(cube);
  for (const char* name : {"cube.ply", "cube.stl", "cube.obj"}) {
    ASSERT_EQ(run({"fetch", service_.job.id(), "mesh", "-o", dir_ / name}).exit_code, 0) << name;
    EXPECT_EQ(core::enclosed_volume(read_named_input(dir_ / name).off.mesh), 8e9) << name;
  }
  ASSERT_EQ(run({"fetch", service_.job.id(), "mesh", "-o", dir_ / "same.off"}).exit_code, 0);
  EXPECT_EQ(tests::read_file(dir_ / "same.off"), core::write_off(cube)) << "as it was submitted";
}

TEST_F(ClientTest, MakeWritesShapes) {
  EXPECT_EQ(run({"make", "torus", "--triangles", "18", "-o", dir_ / "t.off"}).exit_code, 0);
  EXPECT_EQ(core::read_off(tests::read_file(dir_ / "t.off")).mesh.triangles.size(), 18u);
  ::testing::internal::CaptureStdout();
  run({"make", "box", "--size", "3,2,1", "-o", "-"});
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), core::write_off(core::make_box(3, 2, 1)));
  EXPECT_EQ(run({"make", "torus", "--triangles", "7", "-o", dir_ / "t.off"}).exit_code, 2);
  EXPECT_NE(run({"make", "torus", "--triangles", "1e3", "-o", dir_ / "t.off"}).err.find("a whole number"),
            std::string::npos);
  EXPECT_EQ(run({"--json", "make", "box", "-o", "-"}).exit_code, 2);
}

TEST_F(ClientTest, WrongUsageIsTwoAndJsonOnRequest) {
  EXPECT_EQ(run({}).exit_code, 2);
  EXPECT_EQ(run({"frobnicate"}).exit_code, 2);
  const Outcome outcome = run({"submit", dir_ / "cube.off", "--spacing", "-1", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(json::parse(outcome.err).at("error").at("code"), "USAGE");
  // What ends the options is none that is unknown.
  EXPECT_NE(run({"submit", "--points", "x", "--", dir_ / "cube.off"}).err.find("--points"),
            std::string::npos);
  const std::string behind = run({"submit", "--", "-cube.off", "--points", "311"}).err;
  EXPECT_NE(behind.find("options come before --, which ends them: --points"), std::string::npos) << behind;
  for (const char* spacing : {"5mm", "0.1%%", "100%"}) {
    const std::string said = run({"submit", dir_ / "cube.off", "--spacing", spacing}).err;
    EXPECT_NE(said.find("a number > 0 or a share below 100% as in 1%"), std::string::npos) << said;
  }
}

TEST_F(ClientTest, HelpAndVersionGoToStandardOutput) {
  EXPECT_EQ(run({"--version"}).out.substr(0, 15), "affskel-client ");
  for (const auto& order : {std::vector<std::string>{"--json", "--version"}, {"--version", "--json"}}) {
    const json version = json::parse(run(order).out);
    EXPECT_EQ("affskel-client " + version.at("version").get<std::string>() + "\n", run({"--version"}).out);
  }
  const Outcome help = run({"fetch", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("Examples:"), std::string::npos);
  EXPECT_EQ(help.err, "");
}

}  // namespace
}  // namespace affskel::client
