#include "compute.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/files/file_format.h"
#include "core/mesh/map_mesh.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"
#include "tools/vtk_xml_file.h"

namespace affskel::worker {
namespace {

TEST(ComputeTest, AnOutputThatCannotBeWrittenTellsWhy) {
  const tests::TemporaryDirectory directory;
  ComputeOptions options;
  options.file = directory / "box.off";
  options.spacing = 500;
  std::ofstream(options.file) << core::write_off(core::make_box(2000, 2000, 2000));
  const auto error_of = [&](const std::string& output) {
    options.output = output;
    try {
      compute(options);
    } catch (const std::system_error& error) {
      EXPECT_NE(std::string(error.what()).find(output), std::string::npos) << error.what();
      return error.code().value();
    }
    return 0;
  };
  std::filesystem::create_symlink("/dev/full", directory / "full.csv");
  EXPECT_EQ(error_of(directory / "full.csv"), ENOSPC);
  EXPECT_EQ(error_of(directory / "missing/field.csv"), ENOENT);
  EXPECT_EQ(error_of(directory / "field.csv"), 0);
  EXPECT_GT(std::filesystem::file_size(directory / "field.csv"), 0U);
  // Nothing stays behind of the attempts, and a file in place is replaced as a whole.
  const std::filesystem::path field = directory / "field.csv";
  std::ofstream(directory / "kept.csv") << "old";
  std::filesystem::create_symlink("kept.csv", directory / "link.csv");
  std::filesystem::permissions(directory / "kept.csv", std::filesystem::perms(0640));
  EXPECT_EQ(error_of(directory / "link.csv"), 0);
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link.csv"));
  EXPECT_EQ(std::filesystem::file_size(directory / "kept.csv"), std::filesystem::file_size(field));
  EXPECT_EQ(std::filesystem::status(directory / "kept.csv").permissions(), std::filesystem::perms(0640));
  const std::vector<std::string> names = directory.names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()),
            (std::set<std::string>{"box.off", "field.csv", "full.csv", "kept.csv", "link.csv"}));
}

std::vector<std::vector<double>> rows_of(const std::string& path, const std::string& header) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, header);
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    rows.push_back(row);
  }
  return rows;
}

// Near a corner the least of all planes cuts 4.5 times the product of the distances off.
TEST(ComputeTest, TheInfimumIsNotAboveTheSetAndHasItsClosedForm) {
  const tests::TemporaryDirectory directory;
  ComputeOptions options;
  options.file = directory / "box.off";
  options.spacing = 200;
  std::ofstream(options.file) << core::write_off(core::make_box(2000, 2000, 2000));
  options.output = directory / "set.csv";
  compute(options);
  options.minimum = "infimum";
  options.output = directory / "infimum.csv";
  compute(options);
  const auto set = rows_of(directory / "set.csv", "x,y,z,E,nx,ny,nz,direction");
  const auto infimum = rows_of(options.output, "x,y,z,E,nx,ny,nz,slope,saddles");
  ASSERT_EQ(set.size(), 1000U);
  ASSERT_EQ(infimum.size(), set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_LE(infimum[i][3], set[i][3] * (1 + 1e-9));
    EXPECT_EQ(infimum[i][8], 0);
    double product = 1, furthest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double distance = 1000 - std::abs(infimum[i][k] - 1000);
      product *= distance;
      furthest = std::max(furthest, distance);
    }
    if (furthest > 600) continue;
    EXPECT_NEAR(infimum[i][3], 4.5 * product, 1e-8 * product);
    // |grad E| = 4.5 (bc, ca, ab).
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double slope = 4.5 * product / (1000 - std::abs(infimum[i][k] - 1000));
      square += slope * slope;
    }
    EXPECT_NEAR(infimum[i][7], std::sqrt(square), 1e-3 * std::sqrt(square));
  }
}

class ComputeFilesTest : public ::testing::Test {
 protected:
  ComputeFilesTest() {
    options_.file = directory_ / "box.off";
    options_.spacing = 500;
    const core::Mesh box = core::make_box(2000, 2000, 2000);
    std::ofstream(options_.file) << core::write_off(box);
    std::ofstream obj(directory_ / "box.OBJ");
    for (const core::Vec3& p : box.points) obj << "v " << p.x << " " << p.y << " " << p.z << "\n";
    for (const core::Triangle& t : box.triangles)
      obj << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  }

  std::string field(const std::string& name) {
    options_.output = directory_ / name;
    compute(options_);
    return tests::read_file(options_.output);
  }

  tests::TemporaryDirectory directory_;
  ComputeOptions options_;
};

TEST_F(ComputeFilesTest, ReadsWhatSubmitReads) {
  const std::string csv = field("off.csv"), vti = field("off.vti");
  options_.file = directory_ / "box.OBJ";
  EXPECT_EQ(field("obj.csv"), csv);
  EXPECT_EQ(field("obj.vti"), vti) << "also the hash of the text that would be submitted";
  options_.file = directory_ / "off.csv";
  EXPECT_THROW(field("none.csv"), core::CoreError) << "no mesh";
}

TEST_F(ComputeFilesTest, WritesWhatFetchWrites) {
  for (const core::FileFormat format : core::field_formats())
    EXPECT_GT(field("field" + std::string(core::extension_of(format))).size(), 100U);
  const tests::VtkXmlFile image(tests::read_file(directory_ / "field.vti"));
  const auto erosion = image.pieces.at(0).arrays.at("E").numbers<double>();
  const auto inside = image.pieces.at(0).arrays.at("inside").numbers<std::uint8_t>();
  EXPECT_EQ(std::count(inside.begin(), inside.end(), 1), 64) << "4 x 4 x 4 places, and one layer around";
  EXPECT_EQ(inside.size(), 216U);
  // Beside the middle of a face E falls to 0 at the face, half a step away, and as much below it at the next
  // place.
  const auto at = [](std::size_t i, std::size_t j, std::size_t k) { return (k * 6 + j) * 6 + i; };
  EXPECT_NEAR(erosion[at(0, 2, 2)], -erosion[at(1, 2, 2)], 1e-6 * erosion[at(1, 2, 2)]);
  EXPECT_EQ(erosion[at(0, 0, 0)], 0);
  EXPECT_EQ(image.facts.at("v0").numbers<double>(), std::vector<double>{8e9});
  EXPECT_EQ(image.fact("frame"), "axis");
}

TEST_F(ComputeFilesTest, RefusesAnOutputThatCannotHoldTheField) {
  EXPECT_THROW(field("field.ply"), std::invalid_argument);
  EXPECT_THROW(field("field"), std::invalid_argument);
  options_.file = directory_ / "slant.off";
  std::ofstream(options_.file) << core::write_off(
      core::map_mesh(core::shear(0, 1, 0.5), core::make_box(2000, 3000, 4000)));
  options_.frame = "affine";
  EXPECT_THROW(field("field.vti"), std::invalid_argument);
  EXPECT_GT(field("field.vts").size(), 100U);
}

}  // namespace
}  // namespace affskel::worker
