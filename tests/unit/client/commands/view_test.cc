// The command `view` against a server in this process; what is on the page is tested in page_test.cc.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "client/operations/page.h"
#include "client_fixture.h"
#include "sample_data.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

class ViewTest : public ClientTest {
 protected:
  // In the folder there is only what `view` leaves there.
  ViewTest() {
    for (const std::string& name : dir_.names()) std::filesystem::remove(dir_ / name);
  }

  Outcome run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"view", "@last"});
    return ClientTest::run(arguments);
  }

  json facts() const {
    const std::string page = tests::read_file(dir_ / "p.html"), open = "id=\"facts\">";
    const std::size_t begin = page.find(open) + open.size();
    json all = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
    all.update(json(all.at("models").at(0)));
    return all;
  }

  v1::FetchArtifactRequest fetched(v1::ArtifactKind kind) const {
    for (const v1::FetchArtifactRequest& request : service_.fetches) {
      if (request.kind() == kind) return request;
    }
    return {};
  }
};

TEST_F(ViewTest, WritesThePage) {
  const Outcome done = run({"-o", dir_ / "p.html"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "");
  const json all = facts();
  EXPECT_EQ(all.at("name"), "cube");
  EXPECT_EQ(all.at("operator"), "ridge");
  EXPECT_EQ(all.at("threshold"), 0.001);
  EXPECT_EQ(all.at("pointsHere"), 0) << "a sheet needs none";
  EXPECT_EQ(all.at("stands"), "z up, facing -y");
  EXPECT_EQ(all.at("showLevel"), false);
  EXPECT_EQ(all.at("eroded").size(), all.at("levels").size());
  const json told = json::parse(run({"--json", "-o", dir_ / "p.html"}).out);
  EXPECT_EQ(told.at("file"), dir_ / "p.html");
  EXPECT_EQ(told.at("points"), 0);
  EXPECT_EQ(told.at("levels"), all.at("levels"));
  EXPECT_EQ(told.at("bytes"), tests::read_file(dir_ / "p.html").size());
}

TEST_F(ViewTest, TakesTheJobsSkeletonOrAnother) {
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_CENTRAL);
  service_.job.mutable_skeleton()->set_threshold(0.25);
  ASSERT_EQ(run({"-o", dir_ / "p.html"}).exit_code, 0);
  EXPECT_EQ(facts().at("operator"), "central");
  EXPECT_EQ(facts().at("threshold"), 0.25);
  EXPECT_EQ(fetched(v1::ARTIFACT_KIND_DIVERGENCE).skeleton().operator_(), v1::OPERATOR_CENTRAL);
  service_.fetches.clear();
  ASSERT_EQ(run({"--threshold", "5", "-o", dir_ / "p.html"}).exit_code, 0);
  EXPECT_EQ(facts().at("operator"), "central") << "a threshold alone is for the job's operator";
  EXPECT_EQ(facts().at("threshold"), 5);
  EXPECT_EQ(fetched(v1::ARTIFACT_KIND_DIVERGENCE).skeleton().operator_(), v1::OPERATOR_CENTRAL);
}

TEST_F(ViewTest, CarriesTheLevelThatIsAskedForAndShowsIt) {
  ASSERT_EQ(run({"--level", "12.5%", "--up", "x", "-o", dir_ / "p.html"}).exit_code, 0);
  const json all = facts();
  EXPECT_EQ(all.at("levels").at(all.at("firstLevel").get<std::size_t>()), 0.125);
  EXPECT_EQ(all.at("showLevel"), true);
  EXPECT_EQ(all.at("stands").get<std::string>().substr(0, 5), "x up,");
  EXPECT_EQ(run({"--level", "2", "-o", dir_ / "p.html"}).exit_code, 2);
  EXPECT_EQ(run({"--up", "w", "-o", dir_ / "p.html"}).exit_code, 2);
}

TEST_F(ViewTest, WarnsWhereNothingIsLeftAtTheLevelThatIsAskedFor) {
  v1::TriangleMesh nothing;
  nothing.mutable_quality()->set_advice("the largest E is 16 % of v0");
  service_.artifacts[v1::ARTIFACT_KIND_ERODED_SURFACE] = nothing.SerializeAsString();
  const Outcome outcome = run({"--level", "50%", "-o", dir_ / "p.html"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("the eroded solid is empty: the largest E is 16 % of v0"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(run({"-o", dir_ / "p.html"}).err.find("eroded solid is empty"), std::string::npos)
      << "the page's own levels";
}

TEST(ViewLevels, LieEvenlyInTheCubeRootOfE) {
  const std::vector<double> levels = view_levels(0.16, 0, 1000);
  ASSERT_EQ(levels.size(), 8u);
  for (std::size_t l = 0; l < levels.size(); ++l)
    EXPECT_NEAR(std::cbrt(levels[l] / 0.16), 0.2 + 0.74 / 7 * double(l), 0.02);
  EXPECT_EQ(view_levels(0.16, 0, 100'000'000).size(), 3u) << "large surfaces";
  EXPECT_EQ(view_levels(0.16, 0.0331, 1000).size(), 9u);
  EXPECT_EQ(view_levels(0, 0, 1000).size(), 0u);
  EXPECT_EQ(view_levels(0, 0.25, 1000), std::vector<double>{0.25});
}

TEST_F(ViewTest, ShowsTwoJobsOrTwoSkeletonsOfOne) {
  ASSERT_EQ(
      run({"--operator", "ridge", "--operator", "zucker-hummel", "--threshold", "4", "-o", dir_ / "p.html"})
          .exit_code,
      0);
  const json models = facts().at("models");
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].at("operator"), "ridge");
  EXPECT_EQ(models[1].at("operator"), "zucker-hummel");
  EXPECT_EQ(models[1].at("threshold"), 4);
  const json told = json::parse(run({"@last", "--json", "-o", dir_ / "p.html"}).out);
  EXPECT_EQ(told.at("jobs").size(), 2u);
  EXPECT_EQ(facts().at("models")[1].at("operator"), "ridge");
  EXPECT_EQ(run({"@last", "@last", "-o", dir_ / "p.html"}).exit_code, 2) << "three";
}

TEST_F(ViewTest, AnEmptySkeletonIsAWarning) {
  const std::string warning = "warning: the skeleton is empty";
  EXPECT_EQ(run({"-o", dir_ / "p.html"}).err.find(warning), std::string::npos);
  const Outcome done = run({"--operator", "zucker-hummel", "--threshold", "100", "-o", dir_ / "p.html"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_NE(done.err.find(warning), std::string::npos);
}

TEST_F(ViewTest, RefusesAnOperatorThatItDoesNotKnow) {
  service_.job.mutable_skeleton()->set_operator_(static_cast<v1::Operator>(99));
  for (const std::vector<std::string>& threshold :
       {std::vector<std::string>{}, std::vector<std::string>{"--threshold", "3"}}) {
    std::vector<std::string> arguments = {"-o", dir_ / "p.html"};
    arguments.insert(arguments.end(), threshold.begin(), threshold.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find("operator 99"), std::string::npos) << outcome.err;
    EXPECT_TRUE(dir_.names().empty());
  }
  EXPECT_EQ(run({"--operator", "sobel", "-o", dir_ / "p.html"}).exit_code, 0);
}

TEST_F(ViewTest, EveryOperatorBeginsAtItsOwnThreshold) {
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_CENTRAL);
  service_.job.mutable_skeleton()->set_threshold(0.25);
  // types.proto; the spacing is 200.
  for (const auto& [name, threshold] : {std::pair("zucker-hummel", 7.),
                                        {"intermediate", 1 / 200.},
                                        {"central", 0.57 / 200},
                                        {"sobel", 18.25},
                                        {"flux", 7 / 26.}}) {
    ASSERT_EQ(run({"--operator", name, "-o", dir_ / "p.html"}).exit_code, 0) << name;
    EXPECT_EQ(facts().at("operator"), name);
    EXPECT_NEAR(facts().at("threshold").get<double>(), threshold, 0.005 * threshold) << name;
  }
}

TEST_F(ViewTest, ChordsAreShownAsASheet) {
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_CHORDS);
  service_.artifacts.erase(v1::ARTIFACT_KIND_DIVERGENCE);
  v1::TriangleMesh sheet = sample_sheet();
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  const Outcome done = run({"-o", dir_ / "p.html"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(facts().at("arrays").at("sheetPieces").at(2), 1);
  EXPECT_EQ(facts().at("arrays").at("sheetPieceShares").at(2), 1);
  EXPECT_EQ(facts().at("threshold"), 0.005);
  EXPECT_EQ(fetched(v1::ARTIFACT_KIND_SURFACE).surface().skeleton().operator_(), v1::OPERATOR_CHORDS);

  sheet.set_corners(1, 3);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sheet.SerializeAsString();
  EXPECT_EQ(run({"-o", dir_ / "q.html"}).exit_code, 70) << "a corner that does not exist";
  EXPECT_FALSE(std::filesystem::exists(dir_ / "q.html"));
}

TEST_F(ViewTest, WantsAFinishedJobAndAPageToWrite) {
  EXPECT_EQ(run({"-o", dir_ / "p.png"}).exit_code, 2);
  EXPECT_EQ(run({}).exit_code, 2);
  service_.job.set_state(v1::JOB_STATE_RUNNING);
  service_.job.set_directions_done(5);
  service_.job.set_directions_total(12);
  const Outcome early = run({"-o", dir_ / "p.html"});
  EXPECT_EQ(early.exit_code, 4);
  EXPECT_NE(early.err.find("is running: 5 of 12"), std::string::npos) << early.err;
  service_.job.set_state(v1::JOB_STATE_FAILED);
  service_.job.set_directions_done(12);
  service_.job.mutable_error()->set_code("LIMIT");
  service_.job.mutable_error()->set_message("no skeleton");
  const Outcome failed = run({"-o", dir_ / "p.html"});
  EXPECT_EQ(failed.exit_code, 4);
  EXPECT_NE(failed.err.find("failed: "), std::string::npos) << failed.err;
  EXPECT_NE(failed.err.find("no skeleton"), std::string::npos) << failed.err;
  EXPECT_EQ(failed.err.find("12 of 12"), std::string::npos) << failed.err;
  service_.job.set_state(v1::JOB_STATE_CANCELLED);
  EXPECT_NE(run({"-o", dir_ / "p.html"}).err.find("was cancelled"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "p.html"));
}

TEST_F(ViewTest, ADivergenceOfAnotherLatticeIsRefused) {
  service_.artifacts[v1::ARTIFACT_KIND_DIVERGENCE].resize(32);
  EXPECT_EQ(run({"--operator", "zucker-hummel", "-o", dir_ / "p.html"}).exit_code, 70);
}

TEST_F(ViewTest, DamagedTransfersLeaveNoFile) {
  service_.damage = true;
  EXPECT_EQ(run({"-o", dir_ / "p.html"}).exit_code, 70);
  EXPECT_TRUE(dir_.names().empty());
}

}  // namespace
}  // namespace affskel::client
