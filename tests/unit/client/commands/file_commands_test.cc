// compare, transform and perturb, from their arguments to their exit codes.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "client/files/read/read_shape.h"
#include "client_fixture.h"
#include "core/base/affine_map.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/text/off_file.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

using core::Vec3;
using nlohmann::json;

class FileCommandsTest : public ::testing::Test {
 protected:
  FileCommandsTest() {
    tests::write_file(dir_ / "box.off", core::write_off(core::make_box(3, 2, 1)));
    tests::write_file(dir_ / "a.csv", "x,y,z\n0,0,0\n10,0,0\n20,0,0\n30,0,0\n");
    tests::write_file(dir_ / "b.xyz", "0 0 0\n10 1 0\n20 0 2\n");
    tests::write_file(dir_ / "s.csv",
                      "x,y,z,E,nx,ny,nz,direction,H\n1,2,3,10,0,0.6,0.8,5,7.5\n0,0,0,20,1,0,0,6,-8\n");
  }

  Outcome run(const std::vector<std::string>& arguments) { return run_client_in(dir_, arguments); }

  tests::TemporaryDirectory dir_;
};

TEST_F(FileCommandsTest, CompareTellsSharesBothWays) {
  const Outcome done = run({"compare", dir_ / "a.csv", dir_ / "b.xyz", "--radius", "2", "--radii", "2,0,1,4",
                            "--json", "-o", dir_ / "c.csv", "--plot", dir_ / "c.svg"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json document = json::parse(done.out);
  EXPECT_EQ(document.at("a").at("points"), 4);
  EXPECT_EQ(document.at("b").at("points"), 3);
  EXPECT_EQ(document.at("at_radius").at("radius"), 2);
  EXPECT_EQ(document.at("at_radius").at("a_in_b"), 0.75);
  EXPECT_EQ(document.at("at_radius").at("b_in_a"), 1);
  EXPECT_EQ(document.at("curve").size(), 4u);
  EXPECT_EQ(document.at("curve").at(1).at("a_in_b"), 0.5);
  EXPECT_DOUBLE_EQ(document.at("area_under_curve").at("a_in_b").get<double>(), 2.25 / 4);
  EXPECT_DOUBLE_EQ(document.at("area_under_squared_curve").at("a_in_b").get<double>(), 10.75 / 16);
  EXPECT_EQ(document.at("hausdorff").at("a_to_b"), std::sqrt(104.0));
  EXPECT_EQ(document.at("hausdorff").at("b_to_a"), 2);
  EXPECT_EQ(tests::read_file(dir_ / "c.csv"),
            "radius,squared_radius,a_in_b,b_in_a\n0,0,0.25,0.33333333333333331\n"
            "1,1,0.5,0.66666666666666663\n2,4,0.75,1\n4,16,0.75,1\n");
  EXPECT_EQ(tests::read_file(dir_ / "c.svg").substr(0, 4), "<svg");
}

TEST_F(FileCommandsTest, CompareWithoutRadiiGoesByTheBox) {
  const Outcome done = run({"--json", "compare", dir_ / "a.csv", dir_ / "b.xyz"});
  const json document = json::parse(done.out);
  const double delta = std::sqrt(3.0) * 30 / 128;
  EXPECT_DOUBLE_EQ(document.at("at_radius").at("radius").get<double>(), delta);
  EXPECT_EQ(document.at("curve").size(), 17u);
  EXPECT_EQ(document.at("curve").front().at("radius"), 0);
  EXPECT_DOUBLE_EQ(document.at("curve").back().at("radius").get<double>(), 4 * delta);
}

TEST_F(FileCommandsTest, CompareTakesSquaredRadiiAsThePublishedWorkDoes) {
  const Outcome done =
      run({"compare", dir_ / "a.csv", dir_ / "b.xyz", "--squared", "--radii", "1,4,100", "--radius", "4"});
  EXPECT_NE(done.out.find("r^2"), std::string::npos);
  EXPECT_NE(done.out.find("           4     75.00    100.00\n"), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("75.00 % of A in B, 100.00 % of B in A"), std::string::npos) << done.out;
}

TEST_F(FileCommandsTest, CompareKnowsTheChanceLevel) {
  // A single point in the middle of a cube of edge 2: within 0.9 of it lies the ball's share of the cube.
  tests::write_file(dir_ / "cube.off", core::write_off(core::make_box(2, 2, 2)));
  tests::write_file(dir_ / "centre.xyz", "1 1 1\n");
  const Outcome done = run({"--json", "compare", dir_ / "centre.xyz", dir_ / "centre.xyz", "--solid",
                            dir_ / "cube.off", "--radius", "0.9"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json at = json::parse(done.out).at("at_radius");
  EXPECT_NEAR(at.at("chance_in_b").get<double>(), 4.18879 * 0.729 / 8, 0.005);
  EXPECT_EQ(at.at("chance_in_a"), at.at("chance_in_b"));
  EXPECT_EQ(at.at("a_in_b"), 1);
}

TEST_F(FileCommandsTest, CompareSpreadsPointsOverSurfaces) {
  // The box moved by 0.25 along x: the faces across x lie 0.25 away, the others coincide but for a strip.
  EXPECT_EQ(run({"transform", dir_ / "box.off", "-o", dir_ / "m.stl", "--translate", "0.25,0,0"}).exit_code,
            0);
  const Outcome done =
      run({"--json", "compare", dir_ / "box.off", dir_ / "m.stl", "--radius", "0.26", "--samples", "20000"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json document = json::parse(done.out);
  EXPECT_TRUE(document.at("a").at("surface"));
  EXPECT_EQ(document.at("a").at("points"), 20000);
  EXPECT_GT(document.at("at_radius").at("a_in_b"), 0.99);
  EXPECT_NEAR(document.at("hausdorff").at("a_to_b").get<double>(), 0.25, 0.06);
}

TEST_F(FileCommandsTest, CompareRefusesWhatItCannotCompare) {
  tests::write_file(dir_ / "none.csv", "x,y,z\n");
  tests::write_file(dir_ / "nan.csv", "x,y,z\n1,2,3\n1,nan,3\n");
  tests::write_file(dir_ / "same.csv", "x,y,z\n1,2,3\n");
  EXPECT_EQ(run({"compare", dir_ / "a.csv", dir_ / "none.csv"}).exit_code, 3);
  EXPECT_EQ(run({"compare", dir_ / "a.csv", dir_ / "missing.csv"}).exit_code, 3);
  EXPECT_EQ(run({"compare", dir_ / "a.csv", dir_ / "b.xyz", "--solid", dir_ / "a.csv"}).exit_code, 3);
  const Outcome nan = run({"--json", "compare", dir_ / "a.csv", dir_ / "nan.csv"});
  EXPECT_EQ(nan.exit_code, 3);
  EXPECT_EQ(json::parse(nan.err).at("error").at("line"), 3);
  EXPECT_EQ(run({"compare", dir_ / "same.csv", dir_ / "same.csv"}).exit_code, 2);
  EXPECT_EQ(run({"compare", dir_ / "same.csv", dir_ / "same.csv", "--radius", "1"}).exit_code, 0);
  for (const std::vector<std::string>& extra :
       std::vector<std::vector<std::string>>{{"--radii", "0"},
                                             {"--radii", "1,-2"},
                                             {"--radii", "x"},
                                             {"--radius", "0"},
                                             {"--plot", dir_ / "c.png"},
                                             {"-o", dir_ / "c.txt"},
                                             {"--samples", "0"}}) {
    std::vector<std::string> arguments = {"compare", dir_ / "a.csv", dir_ / "b.xyz"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    EXPECT_EQ(run(arguments).exit_code, 2) << extra[0] << " " << extra[1];
  }
  EXPECT_FALSE(std::filesystem::exists(dir_ / "c.png"));
}

TEST_F(FileCommandsTest, CompareKeepsRadiiInRange) {
  const auto code = [&](const std::vector<std::string>& extra) {
    std::vector<std::string> arguments = {"compare", dir_ / "a.csv", dir_ / "b.xyz", "--plot",
                                          dir_ / "c.svg"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    return run(arguments).exit_code;
  };
  for (const char* wrong : {"5e-324", "1e-151", "1.1e150", "1e300"}) {
    EXPECT_EQ(code({"--radius", wrong}), 2) << wrong;
    EXPECT_EQ(code({"--radii", wrong}), 2) << wrong;
  }
  EXPECT_FALSE(std::filesystem::exists(dir_ / "c.svg"));
  for (const char* right : {"1e-150", "1e150"}) {
    EXPECT_EQ(code({"--radius", right}), 0) << right;
    EXPECT_EQ(code({"--radii", right}), 0) << right;
  }
  EXPECT_EQ(code({"--squared", "--radius", "1e-300"}), 0);
  EXPECT_EQ(code({"--squared", "--radius", "1e300"}), 0);
  EXPECT_EQ(code({"--squared", "--radius", "5e-324"}), 2);
}

TEST_F(FileCommandsTest, CompareIsRightOrRefusesAtAnySize) {
  tests::write_file(dir_ / "tiny.csv", "x,y,z\n0,0,0\n1e-170,0,0\n");
  tests::write_file(dir_ / "tiny2.csv", "x,y,z\n0,3e-170,0\n1e-170,3e-170,0\n");
  tests::write_file(dir_ / "huge.csv", "x,y,z\n0,0,0\n1e160,0,0\n");
  const Outcome refused = run({"compare", dir_ / "tiny.csv", dir_ / "tiny2.csv"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("3e-170"), std::string::npos) << refused.err;
  const Outcome tiny = run({"--json", "compare", dir_ / "tiny.csv", dir_ / "tiny2.csv", "--radius", "1"});
  ASSERT_EQ(tiny.exit_code, 0) << tiny.err;
  EXPECT_EQ(json::parse(tiny.out).at("hausdorff").at("a_to_b"), 3e-170);
  const Outcome huge = run({"compare", dir_ / "huge.csv", dir_ / "a.csv"});
  EXPECT_EQ(huge.exit_code, 3);
  EXPECT_NE(huge.err.find("huge.csv"), std::string::npos) << huge.err;
  core::Mesh box = core::make_box(3e-80, 2e-80, 1e-80);
  tests::write_file(dir_ / "tiny.off", core::write_off(box));
  const Outcome surface = run({"compare", dir_ / "tiny.off", dir_ / "a.csv"});
  EXPECT_EQ(surface.exit_code, 3);
  EXPECT_NE(surface.err.find("tiny.off"), std::string::npos) << surface.err;
}

TEST_F(FileCommandsTest, CompareKnowsTheChanceLevelOfThinSolids) {
  // A needle: points within 1e4 of its middle are a fifth of it.  A plate: within 1e5 of its middle lies
  // the disc's share.
  tests::write_file(dir_ / "needle.off", core::write_off(core::make_box(1e5, 1, 1)));
  tests::write_file(dir_ / "needle.xyz", "5e4 0.5 0.5\n");
  tests::write_file(dir_ / "plate.off", core::write_off(core::make_box(1e6, 1e6, 1)));
  tests::write_file(dir_ / "plate.xyz", "5e5 5e5 0.5\n");
  const auto chance = [&](const std::string& name, const char* radius) {
    const Outcome done = run({"--json", "compare", dir_ / (name + ".xyz"), dir_ / (name + ".xyz"), "--solid",
                              dir_ / (name + ".off"), "--radius", radius});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(done.out).at("at_radius").at("chance_in_a").get<double>();
  };
  EXPECT_NEAR(chance("needle", "1e4"), 0.2, 0.002);
  EXPECT_NEAR(chance("plate", "1e5"), 3.14159e-2, 0.001);
}

TEST_F(FileCommandsTest, CompareWritesBothFilesOrNone) {
  tests::write_file(dir_ / "old.svg", "old");
  std::filesystem::create_directory(dir_ / "full.csv");
  for (const std::string& table : {dir_ / "none/c.csv", dir_ / "full.csv"}) {
    const Outcome done =
        run({"compare", dir_ / "a.csv", dir_ / "b.xyz", "--plot", dir_ / "old.svg", "-o", table});
    EXPECT_EQ(done.exit_code, 2);
    EXPECT_NE(done.err.find(table), std::string::npos) << done.err;
    EXPECT_EQ(tests::read_file(dir_ / "old.svg"), "old");
  }
  // A disk that fills up shows only when the table is written.
  std::filesystem::create_symlink("/dev/full", dir_ / "disk.csv");
  EXPECT_EQ(
      run({"compare", dir_ / "a.csv", dir_ / "b.xyz", "--plot", dir_ / "old.svg", "-o", dir_ / "disk.csv"})
          .exit_code,
      8);
  EXPECT_EQ(tests::read_file(dir_ / "old.svg"), "old");
  EXPECT_EQ(dir_.names().size(), 7u) << "temporary files are left";
}

TEST_F(FileCommandsTest, CompareWritesToStandardOutput) {
  const std::vector<std::string> both = {"compare", dir_ / "a.csv", dir_ / "b.xyz"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = both;
    arguments.insert(arguments.end(), more.begin(), more.end());
    ::testing::internal::CaptureStdout();
    const Outcome done = run(arguments);
    return std::pair(done, ::testing::internal::GetCapturedStdout());
  };
  const auto [table, csv] = with({"-o", "-", "--radii", "2"});
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_EQ(csv, "radius,squared_radius,a_in_b,b_in_a\n2,4,0.75,1\n");
  EXPECT_EQ(table.out, "") << "nothing else is there";
  EXPECT_NE(table.err.find("area"), std::string::npos) << "the table for people";
  EXPECT_TRUE(with({"--plot", "-"}).second.starts_with("<svg"));
  EXPECT_EQ(with({"--plot", "-", "-o", "-"}).first.exit_code, 2);
  EXPECT_EQ(with({"--json", "-o", "-"}).first.exit_code, 2);
}

// In a process of its own, which the budget ends.
TEST_F(FileCommandsTest, CompareHasTheBudgetsOfOtherCommands) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";  // a new process has no memory to spare
  std::string points = "x,y,z\n";
  for (int i = 0; i < 100000; ++i) points += std::to_string(i) + ",0,0\n";
  tests::write_file(dir_ / "many.csv", points);
  EXPECT_EXIT(run({"--memory", "10K", "compare", dir_ / "many.csv", dir_ / "a.csv"}),
              ::testing::ExitedWithCode(8), "many.csv: reading it takes more than 10240 bytes of memory");
}

TEST_F(FileCommandsTest, StlThatWouldBeSpoiltIsRefusedByName) {
  const Outcome done =
      run({"transform", dir_ / "box.off", "-o", dir_ / "far.stl", "--translate", "1e9,1e9,1e9"});
  EXPECT_EQ(done.exit_code, 8);
  EXPECT_NE(done.err.find("far.stl: .stl holds single precision"), std::string::npos) << done.err;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "far.stl"));
  EXPECT_EQ(run({"make", "box", "--size", "1e39,1,1", "-o", dir_ / "far.stl"}).exit_code, 8);
}

TEST_F(FileCommandsTest, ChangedNamesOfColumnsAreTold) {
  tests::write_file(dir_ / "n.csv", "x,y,z,my col\n1,2,3,4\n");
  const Outcome done = run({"transform", dir_ / "n.csv", "-o", dir_ / "t.ply", "--scale", "2"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_NE(done.err.find("column 'my col' is written as 'my_col'"), std::string::npos) << done.err;
  EXPECT_EQ(read_shape(dir_ / "t.ply").columns.at(0).name, "my_col");
}

TEST_F(FileCommandsTest, TransformTakesTheStepsInTheOrderGiven) {
  ASSERT_EQ(run({"transform", dir_ / "a.csv", "-o", dir_ / "t.csv", "--scale", "2", "--translate", "1,0,0",
                 "--scale", "10", "--rotate", "z:90"})
                .exit_code,
            0);
  EXPECT_EQ(read_shape(dir_ / "t.csv").mesh().points[1], (Vec3{0, 210, 0}));
  ASSERT_EQ(run({"transform", dir_ / "t.csv", "-o", dir_ / "u.csv", "--scale", "2", "--translate", "1,0,0",
                 "--scale", "10", "--rotate", "z:90", "--inverse"})
                .exit_code,
            0);
  const ShapeFile back = read_shape(dir_ / "u.csv");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(norm(back.mesh().points[i] - Vec3{10.0 * double(i), 0, 0}), 0, 1e-12);
  }
}

TEST_F(FileCommandsTest, TransformMapsWhatBelongsToThePoints) {
  ASSERT_EQ(run({"transform", dir_ / "s.csv", "-o", dir_ / "t.ply", "--scale", "1,1,-2", "--shear", "y+=z"})
                .exit_code,
            0);
  const ShapeFile shape = read_shape(dir_ / "t.ply");
  EXPECT_EQ(shape.mesh().points[0], (Vec3{1, -4, -6}));
  EXPECT_EQ(shape.column("E")->values, (std::vector<double>{20, 40}));
  EXPECT_EQ(shape.column("H")->values, (std::vector<double>{7.5, -8}));
  EXPECT_EQ(shape.column("direction")->values, (std::vector<double>{5, 6}));
  EXPECT_TRUE(shape.column("direction")->whole);
  // (0, .6, .8) is normal to (0, .8, -.6), which becomes (0, .8 + 1.2, 1.2), and points to the side of
  // (0, .6, .8), which becomes (0, .6 - 1.6, -1.6).
  const double length = std::hypot(0.6, 1.0);
  EXPECT_NEAR(shape.column("ny")->values[0], 0.6 / length, 1e-15);
  EXPECT_NEAR(shape.column("nz")->values[0], -1.0 / length, 1e-15);
  EXPECT_EQ(shape.column("nx")->values[1], 1);
}

TEST_F(FileCommandsTest, TransformKnowsOtherNamesOfNormals) {
  tests::write_file(dir_ / "n.csv", "x,y,z,nx_a,ny_a,nz_a,n2x,n2y,n2z,nice\n0,0,0,0,0,1,1,0,0,3\n");
  ASSERT_EQ(run({"transform", dir_ / "n.csv", "-o", dir_ / "t.csv", "--rotate", "y:90"}).exit_code, 0);
  const ShapeFile shape = read_shape(dir_ / "t.csv");
  EXPECT_EQ(shape.column("nx_a")->values[0], 1);
  EXPECT_EQ(shape.column("nz_a")->values[0], 0);
  EXPECT_EQ(shape.column("n2z")->values[0], -1);
  EXPECT_EQ(shape.column("nice")->values[0], 3);
}

TEST_F(FileCommandsTest, TransformKeepsMirroredMeshesOutward) {
  const Outcome done =
      run({"--json", "transform", dir_ / "box.off", "-o", dir_ / "t.ply", "--scale", "-2,1,1"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(json::parse(done.out).at("determinant"), -2);
  EXPECT_EQ(json::parse(done.out).at("triangles"), 12);
  const core::Solid solid = core::make_solid(read_shape(dir_ / "t.ply").mesh());
  EXPECT_EQ(solid.volume, 12);
  EXPECT_TRUE(solid.notes.empty());
}

TEST_F(FileCommandsTest, TransformRefusesWhatIsNoMap) {
  const std::vector<std::vector<std::string>> wrong = {
      {},         {"--scale", "0"}, {"--matrix", "1,2,3,4,5,6,7,8,9"}, {"--rotate", "30"}, {"--inverse"},
      {"--shear"}};
  for (const std::vector<std::string>& extra : wrong) {
    std::vector<std::string> arguments = {"transform", dir_ / "box.off", "-o", dir_ / "t.off"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    EXPECT_EQ(run(arguments).exit_code, 2);
  }
  EXPECT_EQ(run({"transform", dir_ / "box.off", "-o", dir_ / "t.csv", "--scale", "2"}).exit_code, 2);
  EXPECT_EQ(run({"transform", dir_ / "a.csv", "-o", dir_ / "t.stl", "--scale", "2"}).exit_code, 2);
  EXPECT_EQ(run({"transform", dir_ / "none.off", "-o", dir_ / "t.off", "--scale", "2"}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "t.off"));
}

TEST_F(FileCommandsTest, TransformTellsWhichColumnsAreLost) {
  const Outcome done = run({"transform", dir_ / "s.csv", "-o", dir_ / "t.xyz", "--scale", "2"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_NE(done.err.find("E, nx, ny, nz, direction, H"), std::string::npos) << done.err;
}

TEST_F(FileCommandsTest, PerturbMovesEveryVertexByAShareOfTheDiagonal) {
  const Outcome done =
      run({"--json", "perturb", dir_ / "box.off", "-o", dir_ / "p.off", "--noise", "0.5%", "--seed", "3"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json document = json::parse(done.out);
  const double sigma = 0.005 * std::sqrt(14.0);
  EXPECT_DOUBLE_EQ(document.at("sigma").get<double>(), sigma);
  EXPECT_EQ(document.at("seed"), 3);
  EXPECT_FALSE(document.at("self_intersecting"));
  const core::Mesh box = core::make_box(3, 2, 1),
                   noisy = core::read_off(tests::read_file(dir_ / "p.off")).mesh;
  for (std::size_t v = 0; v < box.points.size(); ++v) {
    EXPECT_GT(norm(noisy.points[v] - box.points[v]), 0);
    EXPECT_LT(norm(noisy.points[v] - box.points[v]), 6 * sigma);
  }
  // The same again, the share said otherwise, and as a length.
  EXPECT_EQ(
      run({"perturb", dir_ / "box.off", "-o", dir_ / "q.off", "--noise", "0.005", "--seed", "3"}).exit_code,
      0);
  EXPECT_EQ(tests::read_file(dir_ / "q.off"), tests::read_file(dir_ / "p.off"));
  EXPECT_EQ(
      run({"perturb", dir_ / "box.off", "-o", dir_ / "q.off", "--sigma", "0.01", "--seed", "3"}).exit_code,
      0);
  EXPECT_NE(tests::read_file(dir_ / "q.off"), tests::read_file(dir_ / "p.off"));
}

TEST_F(FileCommandsTest, PerturbWarnsWhenTheSurfaceCrossesItself) {
  tests::write_file(dir_ / "sphere.off", core::write_off(core::make_sphere(1, 1280)));
  const Outcome done =
      run({"--quiet", "perturb", dir_ / "sphere.off", "-o", dir_ / "p.off", "--noise", "10%"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_NE(done.err.find("crosses itself"), std::string::npos);
}

TEST_F(FileCommandsTest, PerturbRefusesWhatIsNoNoise) {
  for (const std::vector<std::string>& extra :
       std::vector<std::vector<std::string>>{{},
                                             {"--noise", "-1%"},
                                             {"--noise", "x"},
                                             {"--noise", "%"},
                                             {"--sigma", "-1"},
                                             {"--seed", "x", "--sigma", "1"},
                                             {"--sigma", "1", "--noise", "1%"}}) {
    std::vector<std::string> arguments = {"perturb", dir_ / "box.off", "-o", dir_ / "p.off"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    EXPECT_EQ(run(arguments).exit_code, 2);
  }
  EXPECT_EQ(run({"perturb", dir_ / "a.csv", "-o", dir_ / "p.off", "--sigma", "1"}).exit_code, 3);
  EXPECT_EQ(run({"perturb", dir_ / "box.off", "-o", dir_ / "p.xyz", "--sigma", "1"}).exit_code, 2);
}

}  // namespace
}  // namespace affskel::client
