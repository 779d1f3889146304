// The command measure, and what else tells of parts, against a server in this process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "client_fixture.h"
#include "sample_data.h"
#include "tools/files.h"

namespace affskel::client {
namespace {

using nlohmann::json;

using MeasureTest = ClientTest;

TEST_F(MeasureTest, TellsOfTheWholeAndItsParts) {
  const Outcome outcome = run({"--json", "measure", "@last"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  ASSERT_EQ(service_.fetches.size(), 1U);
  EXPECT_EQ(service_.fetches.front().kind(), v1::ARTIFACT_KIND_PARTS);
  EXPECT_EQ(service_.fetches.front().skeleton().operator_(), v1::OPERATOR_CURVE);
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["whole"]["volume_units3"], 8e9);
  EXPECT_EQ(found["whole"]["surface_area_units2"], 2.4e7);
  EXPECT_EQ(found["whole"]["curve_length_units"], 12);
  EXPECT_EQ(found["whole"]["greatest_E_units3"], 9);
  EXPECT_EQ(found["whole"]["greatest_E_place"], json({4, 0, 0}));
  EXPECT_EQ(found["whole"]["sheet_area_units2"], 7);
  EXPECT_EQ(found["whole"]["ends"], 3);
  ASSERT_EQ(found["parts"].size(), 3U);
  const json& first = found["parts"][0];
  EXPECT_EQ(first["part"], 1);
  EXPECT_EQ(first["kind"], "limb");
  EXPECT_EQ(first["volume_share"], 0.7);
  EXPECT_EQ(first["surface_area_units2"], 8e6);
  EXPECT_TRUE(first["angle_degrees"].is_null());
  EXPECT_TRUE(first["angle_to_part"].is_null());
  EXPECT_EQ(first["to_x"], 0);
  EXPECT_EQ(found["parts"][1]["angle_degrees"], 127);
  EXPECT_EQ(found["parts"][1]["angle_to_part"], 1);
  EXPECT_EQ(found["parts"][1]["length_units"], 5);
}

TEST_F(MeasureTest, WritesATable) {
  const std::string csv = dir_ / "limbs.csv";
  ASSERT_EQ(run({"measure", "@last", "--threshold", "2", "-o", csv}).exit_code, 0);
  EXPECT_EQ(service_.fetches.front().skeleton().threshold(), 2);
  std::istringstream lines(tests::read_file(csv));
  std::string head, row;
  ASSERT_TRUE(std::getline(lines, head) && std::getline(lines, row));
  EXPECT_TRUE(head.starts_with("part,kind,length_units,straight_length_units,volume_units3"));
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_TRUE(row.starts_with("1,limb,4,4,")) << row;
  EXPECT_NE(row.find(",2,1,3,,4,0,0,"), std::string::npos) << "no angle: " << row;
  const std::string file = dir_ / "limbs.json";
  ASSERT_EQ(run({"measure", "@last", "-o", file}).exit_code, 0);
  EXPECT_EQ(json::parse(tests::read_file(file))["parts"].size(), 3U);
  const Outcome shown = run({"measure", "@last"});
  EXPECT_NE(shown.out.find("surface_area:"), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("\n    1  limb          70"), std::string::npos) << shown.out;
}

// As of a link within joints, or made by an earlier version.
TEST_F(MeasureTest, AnAngleMayBeToNoPart) {
  v1::SolidParts parts = sample_parts();
  parts.mutable_parts(1)->clear_angle_to();
  service_.artifacts[v1::ARTIFACT_KIND_PARTS] = parts.SerializeAsString();
  const json found = json::parse(run({"--json", "measure", "@last"}).out);
  EXPECT_EQ(found["parts"][1]["angle_degrees"], 127);
  EXPECT_TRUE(found["parts"][1]["angle_to_part"].is_null());
  EXPECT_NE(run({"measure", "@last"}).out.find("127   -  ("), std::string::npos);
  parts.mutable_parts(1)->set_angle_to(4);
  service_.artifacts[v1::ARTIFACT_KIND_PARTS] = parts.SerializeAsString();
  const Outcome outcome = run({"measure", "@last"});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("a part out of range"), std::string::npos) << outcome.err;
}

TEST_F(MeasureTest, NumbersStandApartHoweverLong) {
  v1::SolidParts parts = sample_parts();
  parts.mutable_parts(1)->set_greatest_radius(0.5642);
  parts.mutable_parts(1)->set_angle(0.000692);
  service_.artifacts[v1::ARTIFACT_KIND_PARTS] = parts.SerializeAsString();
  const Outcome outcome = run({"measure", "@last"});
  EXPECT_NE(outcome.out.find("0.5642 0.000692   1  ("), std::string::npos) << outcome.out;
}

TEST_F(MeasureTest, ABallIsOnePart) {
  v1::SolidParts ball = sample_parts();
  ball.mutable_parts()->DeleteSubrange(1, 2);
  ball.mutable_parts(0)->set_kind(v1::PART_KIND_POINT);
  ball.mutable_curve()->clear_segments();
  ball.mutable_curve()->mutable_quality()->set_advice("no limb");
  for (std::uint32_t& part : *ball.mutable_point_part()) part = 1;
  for (std::uint32_t& part : *ball.mutable_triangle_part()) part = 1;
  service_.artifacts[v1::ARTIFACT_KIND_PARTS] = ball.SerializeAsString();
  const Outcome outcome = run({"measure", "@last"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("no limb"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("\n    1  point"), std::string::npos) << outcome.out;
}

TEST_F(MeasureTest, RefusesOtherFormats) {
  EXPECT_EQ(run({"measure", "@last", "-o", dir_ / "limbs.xlsx"}).exit_code, 2);
  EXPECT_EQ(run({"measure", "@last", "--threshold", "0"}).exit_code, 2);
  EXPECT_EQ(run({"measure", "@last", "--format", "csv"}).exit_code, 2) << "there is no file";
  EXPECT_TRUE(service_.fetches.empty()) << "before anything is asked";
}

TEST_F(MeasureTest, DamagedPartsAreNotBelieved) {
  const auto damaged = [&](auto&& damage) {
    v1::SolidParts parts = sample_parts();
    damage(parts);
    service_.artifacts[v1::ARTIFACT_KIND_PARTS] = parts.SerializeAsString();
    const Outcome outcome = run({"measure", "@last"});
    EXPECT_NE(outcome.err.find("damaged parts"), std::string::npos) << outcome.err;
    return outcome.exit_code;
  };
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.set_triangle_part(3, 4); }), 70);
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.set_point_part(0, 0); }), 70);
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.mutable_surface()->set_corners(5, 8); }), 70);
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.mutable_surface()->clear_corners(); }), 70);
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.mutable_thickness()->RemoveLast(); }), 70);
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.clear_greatest_place(); }), 70);
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.mutable_parts(1)->clear_to(); }), 70);
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.mutable_parts(1)->add_vertices(4); }), 70);
  EXPECT_EQ(damaged([](v1::SolidParts& p) { p.mutable_curve()->mutable_segments()->Set(1, 9); }), 70);
}

TEST_F(MeasureTest, FetchWritesTheCurveAsAGraph) {
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sample_parts().curve().SerializeAsString();
  const std::string file = dir_ / "curve.json";
  ASSERT_EQ(run({"fetch", "@last", "curve", "-o", file}).exit_code, 0);
  const json graph = json::parse(tests::read_file(file));
  EXPECT_EQ(graph["nodes"].size(), 4U);
  EXPECT_EQ(graph["branches"].size(), 3U);
  v1::TriangleMesh looped = sample_parts().curve();
  looped.mutable_quality()->set_holes(1);
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = looped.SerializeAsString();
  const Outcome outcome = run({"fetch", "@last", "curve", "-o", dir_ / "curve.swc"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("1 loop cut"), std::string::npos) << outcome.err;
  EXPECT_EQ(run({"fetch", "@last", "curve", "-o", dir_ / "curve.stl"}).exit_code, 2);
  const Outcome vertices = run({"fetch", "@last", "curve", "-o", dir_ / "curve.csv"});
  EXPECT_NE(vertices.err.find("(curve, 4 points)"), std::string::npos) << vertices.err;
  const std::string table = tests::read_file(dir_ / "curve.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 4);
  EXPECT_NE(table.substr(0, table.find('\n')).find("radius"), std::string::npos) << table;
  ASSERT_EQ(run({"fetch", "@last", "curve", "-o", dir_ / "curve.glb"}).exit_code, 0);
  EXPECT_EQ(service_.fetches.back().kind(), v1::ARTIFACT_KIND_PARTS);
  EXPECT_TRUE(tests::read_file(dir_ / "curve.glb").starts_with("glTF"));
}

TEST_F(MeasureTest, ASkeletonThatIsACurveIsWrittenAsFetchCurveDoes) {
  service_.artifacts[v1::ARTIFACT_KIND_SURFACE] = sample_parts().curve().SerializeAsString();
  for (const char* extension : {".swc", ".json", ".graphml", ".glb"}) {
    const std::string file = dir_ / (std::string("c") + extension),
                      same = dir_ / (std::string("d") + extension);
    const Outcome named = run({"skeleton", "@last", "--operator", "curve", "-o", file});
    ASSERT_EQ(named.exit_code, 0) << named.err;
    ASSERT_EQ(run({"fetch", "@last", "curve", "-o", same}).exit_code, 0);
    EXPECT_EQ(tests::read_file(file), tests::read_file(same));
  }
  EXPECT_EQ(run({"skeleton", "@last", "--operator", "ridge", "-o", dir_ / "c.swc"}).exit_code, 2);
  EXPECT_EQ(
      run({"skeleton", "@last", "--operator", "curve", "--as", "points", "-o", dir_ / "c.swc"}).exit_code, 2);
  service_.job.mutable_skeleton()->set_operator_(v1::OPERATOR_CURVE);
  EXPECT_EQ(run({"skeleton", "@last", "-o", dir_ / "c.swc"}).exit_code, 0) << "the job's own";
}

TEST_F(MeasureTest, TheFieldHasPartsWhereTheyAreAskedFor) {
  const std::string file = dir_ / "field.csv";
  ASSERT_EQ(run({"fetch", "@last", "field", "--parts", "-o", file}).exit_code, 0);
  std::istringstream lines(tests::read_file(file));
  std::string line, parts;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, "x,y,z,E,nx,ny,nz,direction,part");
  while (std::getline(lines, line)) parts.push_back(line.back());
  EXPECT_EQ(parts, "11231") << "in the order of the sample points";
  EXPECT_EQ(run({"fetch", "@last", "mesh", "--parts", "-o", dir_ / "m.off"}).exit_code, 2);
  EXPECT_EQ(run({"fetch", "@last", "field", "--parts", "-o", dir_ / "f.dat"}).exit_code, 2) << "no column";
  v1::SolidParts other = sample_parts();
  other.add_point_part(1);
  service_.artifacts[v1::ARTIFACT_KIND_PARTS] = other.SerializeAsString();
  EXPECT_EQ(run({"fetch", "@last", "field", "--parts", "-o", file}).exit_code, 70) << "of another lattice";
}

TEST_F(MeasureTest, ThicknessIsAColumnOfTriangles) {
  const std::string ply = dir_ / "t.ply", vtp = dir_ / "t.vtp";
  const Outcome outcome = run({"fetch", "@last", "thickness", "-o", ply});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("(thickness, 12 triangles)"), std::string::npos) << outcome.err;
  const std::string text = tests::read_file(ply);
  EXPECT_NE(
      text.find("property list uchar int vertex_indices\nproperty double thickness\nproperty int part\n"),
      std::string::npos);
  // Of the last triangle.
  double thickness = 0;
  std::int32_t part = 0;
  std::memcpy(&thickness, text.data() + text.size() - 12, 8);
  std::memcpy(&part, text.data() + text.size() - 4, 4);
  EXPECT_EQ(thickness, 111);
  EXPECT_EQ(part, 3);
  ASSERT_EQ(run({"fetch", "@last", "thickness", "-o", vtp}).exit_code, 0);
  EXPECT_NE(tests::read_file(vtp).find("<CellData Scalars=\"thickness\">"), std::string::npos);
  EXPECT_EQ(run({"fetch", "@last", "thickness", "-o", dir_ / "t.off"}).exit_code, 2);
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
}

// As of a bowl, of whose thickness it makes several times what it is.
TEST_F(MeasureTest, WhatIsWrongWithTheSkeletonIsToldWithAllThatIsMeasuredByIt) {
  v1::SolidParts bare = sample_parts();
  bare.mutable_curve()->mutable_quality()->set_advice("66 % of the solid are farther from it.");
  service_.artifacts[v1::ARTIFACT_KIND_PARTS] = bare.SerializeAsString();
  const std::string told = "the skeleton: 66 % of the solid are farther from it.";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"measure", "@last"},
        {"fetch", "@last", "thickness", "-o", dir_ / "t.ply"},
        {"fetch", "@last", "curve", "-o", dir_ / "t.glb"},
        {"render", "@last", "--colour", "thickness", "-o", dir_ / "t.png", "--width", "300"}})
    EXPECT_NE(run(command).err.find(told), std::string::npos) << command.back();
  EXPECT_NE(tests::read_file(dir_ / "t.ply").find("mesh units; " + told), std::string::npos);
  const json document = json::parse(run({"--json", "fetch", "@last", "thickness", "-o", dir_ / "t.vtp"}).out);
  EXPECT_EQ(document.at("quality").at("advice"), "66 % of the solid are farther from it.");
}

TEST_F(MeasureTest, PicturesArePaintedByPartAndThickness) {
  const auto picture = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command = {"render", "@last", "-o", dir_ / "p.png", "--width", "300"};
    command.insert(command.end(), options.begin(), options.end());
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return tests::read_file(dir_ / "p.png");
  };
  const std::string plain = picture({"--colour", "E"}), part = picture({"--colour", "part"}),
                    thickness = picture({"--colour", "thickness"});
  EXPECT_EQ(plain, picture({}));
  EXPECT_NE(plain, part);
  EXPECT_NE(part, thickness);
  EXPECT_NE(part, picture({"--colour", "part", "--background", "dark"}));
  for (const char* other : {"--no-mesh", "--threshold=3", "--operator=ridge"})
    EXPECT_EQ(run({"render", "@last", "-o", dir_ / "w.png", "--colour", "part", other}).exit_code, 2)
        << other;
  EXPECT_EQ(run({"render", "@last", "-o", dir_ / "w.png", "--colour", "red"}).exit_code, 2);
}

}  // namespace
}  // namespace affskel::client
