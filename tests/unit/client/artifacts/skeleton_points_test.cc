#include "client/artifacts/skeleton_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "client/base/colour.h"
#include "client/base/error.h"
#include "client/files/write/shape_writer.h"
#include "sample_data.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

std::string written_points(FileFormat format, const v1::SkeletonPoints& skeleton,
                           const std::vector<std::string>& comments = {}) {
  const tests::TemporaryDirectory dir;
  base::AtomicFile file(dir / "s");
  write_into(file,
             [&](const WriteBytes& write) { write_points(format, shape_of(skeleton), comments, write); });
  file.commit();
  return tests::read_file(dir / "s");
}

TEST(SkeletonWriter, CsvReadsBackExactly) {
  std::istringstream in(written_points(FileFormat::kCsv, sample_skeleton()));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "x,y,z,E,nx,ny,nz,direction,H");
  const v1::SkeletonPoints s = sample_skeleton();
  for (int p = 0; p < 2; ++p) {
    ASSERT_TRUE(std::getline(in, line));
    std::istringstream cells(line);
    std::vector<double> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
    ASSERT_EQ(values.size(), 9u);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(values[std::size_t(c)], s.xyz(3 * p + c));
      EXPECT_EQ(values[std::size_t(4 + c)], s.normal(3 * p + c));
    }
    EXPECT_EQ(values[3], s.erosion(p));
    EXPECT_EQ(values[7], s.direction(p));
    EXPECT_EQ(values[8], s.divergence(p));
  }
  EXPECT_FALSE(std::getline(in, line));
}

TEST(SkeletonWriter, PlyHeaderDescribesTheBytes) {
  const std::string ply =
      written_points(FileFormat::kPly, sample_skeleton(), {"job 0123", "two\x1b[2Jlines"});
  const std::string end = "end_header\n";
  const std::size_t body = ply.find(end) + end.size();
  const std::string header = ply.substr(0, body);
  EXPECT_EQ(header,
            "ply\nformat binary_little_endian 1.0\ncomment job 0123\ncomment two?[2Jlines\nelement vertex 2\n"
            "property double x\nproperty double y\nproperty double z\nproperty double E\n"
            "property double nx\nproperty double ny\nproperty double nz\n"
            "property int direction\nproperty double H\nproperty float quality\nproperty uchar red\n"
            "property uchar green\nproperty uchar blue\nend_header\n");
  constexpr std::size_t kRow = 8 * 8 + 4 + 4 + 3;
  ASSERT_EQ(ply.size(), body + 2 * kRow);
  const v1::SkeletonPoints s = sample_skeleton();
  for (int p = 0; p < 2; ++p) {
    double row[7], divergence = 0;
    std::int32_t direction = 0;
    const char* at = ply.data() + body + std::size_t(p) * kRow;
    std::memcpy(row, at, sizeof row);
    std::memcpy(&direction, at + sizeof row, sizeof direction);
    std::memcpy(&divergence, at + sizeof row + sizeof direction, sizeof divergence);
    float quality = 0;
    std::memcpy(&quality, at + 68, sizeof quality);
    EXPECT_EQ(quality, static_cast<float>(s.erosion(p)));
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(row[c], s.xyz(3 * p + c));
      EXPECT_EQ(row[4 + c], s.normal(3 * p + c));
    }
    EXPECT_EQ(row[3], s.erosion(p));
    EXPECT_EQ(divergence, s.divergence(p));
    EXPECT_EQ(direction, std::int32_t(s.direction(p)));
  }
  // The colours are those of the pictures: the largest E is yellow, the other stands at the cube root of its
  // share.
  const Rgb wanted = viridis(std::cbrt(static_cast<float>(s.erosion(0) / s.erosion(1))));
  const auto colours = [&](std::size_t p) { return ply.substr(body + p * kRow + 72, 3); };
  EXPECT_EQ(colours(1), "\xFD\xE7\x25");
  EXPECT_NEAR(static_cast<unsigned char>(colours(0)[1]), 255 * wanted.g, 1);
}

TEST(SkeletonWriter, OffAndXyzHoldTheCoordinates) {
  const std::string xyz = written_points(FileFormat::kXyz, sample_skeleton());
  EXPECT_EQ(written_points(FileFormat::kOff, sample_skeleton()), "OFF\n2 0 0\n" + xyz);
  EXPECT_EQ(written_points(FileFormat::kOff, sample_skeleton(), {"job 0\n1"}),
            "OFF\n# job 0 1\n2 0 0\n" + xyz);
  std::istringstream in(xyz);
  const v1::SkeletonPoints skeleton = sample_skeleton();
  for (const double expected : skeleton.xyz()) {
    double value = 0;
    ASSERT_TRUE(in >> value);
    EXPECT_EQ(value, expected);
  }
}

TEST(SkeletonWriter, AnEmptySkeletonIsAValidFile) {
  EXPECT_EQ(written_points(FileFormat::kCsv, {}), "x,y,z,E,nx,ny,nz,direction,H\n");
  EXPECT_NE(written_points(FileFormat::kPly, {}).find("element vertex 0\n"), std::string::npos);
  EXPECT_EQ(written_points(FileFormat::kXyz, {}), "");
}

TEST(ParseSkeleton, RefusesArraysOfDifferentLengths) {
  v1::SkeletonPoints s = sample_skeleton();
  EXPECT_EQ(parse_skeleton(s.SerializeAsString()).point_size(), 2);
  s.add_erosion(1);
  EXPECT_THROW(parse_skeleton(s.SerializeAsString()), ClientError);
  EXPECT_THROW(parse_skeleton("\xff\xff"), ClientError);
}

}  // namespace
}  // namespace affskel::client
