// The command erode, against a server in this process.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "client_fixture.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

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
  EXPECT_NE(told.err.find("2 points, volume about 3200000000"), std::string::npos) << told.err;
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

}  // namespace
}  // namespace affskel::client
