#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "client/artifacts/skeleton_points.h"
#include "client/base/error.h"
#include "client/files/write/shape_writer.h"
#include "sample_data.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"
#include "tools/vtk_xml_file.h"

namespace affskel::client {
namespace {

// What a VTK reader finds in the one piece of a file.
class VtpFile : public tests::VtkXmlFile {
 public:
  explicit VtpFile(const std::string& file) : VtkXmlFile(file) {
    EXPECT_EQ(file.substr(0, 22), "<?xml version=\"1.0\"?>\n");
    EXPECT_EQ(
        tag("VTKFile"),
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">");
    EXPECT_EQ(pieces.size(), 1u);
    arrays = pieces.at(0).arrays;
  }

  int count(const char* of) const {
    return std::stoi(attribute(pieces.at(0).tag, std::string("NumberOf") + of));
  }

  template <typename Number>
  std::vector<Number> numbers(const std::string& name, const char* type) const {
    const auto found = arrays.find(name);
    if (found == arrays.end()) {
      ADD_FAILURE() << "no array " << name;
      return {};
    }
    EXPECT_EQ(found->second.type, type) << name;
    return found->second.numbers<Number>();
  }
  std::vector<double> doubles(const std::string& name) const { return numbers<double>(name, "Float64"); }
  std::vector<std::int64_t> indices(const std::string& name) const {
    return numbers<std::int64_t>(name, "Int64");
  }

  std::map<std::string, Array> arrays;
};

using Doubles = std::vector<double>;
using Indices = std::vector<std::int64_t>;

VtpFile written_skeleton(const v1::SkeletonPoints& skeleton, const std::vector<std::string>& comments = {}) {
  const tests::TemporaryDirectory dir;
  base::AtomicFile file(dir / "s");
  write_into(file, [&](const WriteBytes& write) {
    write_points(FileFormat::kVtp, shape_of(skeleton), comments, write);
  });
  file.commit();
  return VtpFile(tests::read_file(dir / "s"));
}

TEST(VtpWriter, ASkeletonIsVerticesWithArrays) {
  const v1::SkeletonPoints s = sample_skeleton();
  const VtpFile file = written_skeleton(s, {"job 0123", "two\x1b[2J\nlines"});
  EXPECT_EQ(file.count("Points"), 2);
  EXPECT_EQ(file.count("Verts"), 2);
  EXPECT_EQ(file.count("Polys"), 0);
  EXPECT_EQ(file.doubles("Points"), Doubles(s.xyz().begin(), s.xyz().end()));
  EXPECT_EQ(file.arrays.at("Points").section, "Points");
  EXPECT_EQ(file.arrays.at("Points").components, 3);
  EXPECT_EQ(file.arrays.at("connectivity").section, "Verts");
  EXPECT_EQ(file.indices("connectivity"), (Indices{0, 1}));
  EXPECT_EQ(file.indices("offsets"), (Indices{1, 2}));
  EXPECT_EQ(file.tag("PointData"), "<PointData Scalars=\"E\">");
  EXPECT_EQ(file.doubles("E"), Doubles(s.erosion().begin(), s.erosion().end()));
  EXPECT_EQ(file.doubles("normal"), Doubles(s.normal().begin(), s.normal().end()));
  EXPECT_EQ(file.arrays.at("normal").components, 3);
  EXPECT_EQ(file.arrays.at("normal").section, "PointData");
  EXPECT_EQ(file.doubles("H"), Doubles(s.divergence().begin(), s.divergence().end()));
  EXPECT_EQ(file.numbers<std::int32_t>("direction", "Int32"), (std::vector<std::int32_t>{1, 1}));
  EXPECT_EQ(file.arrays.size(), 7u);
  const VtpFile::Array& comment = file.facts.at("comment");
  EXPECT_EQ(comment.type, "String");
  EXPECT_EQ(VtpFile::attribute(comment.tag, "NumberOfTuples"), "2");
  EXPECT_EQ(comment.bytes, std::string("job 0123\0two?[2J lines\0", 23));
}

TEST(VtpWriter, PointsOfAnErodedSolidHaveNoH) {
  v1::SkeletonPoints eroded = sample_skeleton();
  eroded.clear_divergence();
  EXPECT_EQ(written_skeleton(eroded).arrays.count("H"), 0u);
  EXPECT_EQ(written_skeleton(eroded).facts.count("comment"), 0u);
}

TEST(VtpWriter, AnEmptySkeletonIsAValidFile) {
  const VtpFile file = written_skeleton({});
  EXPECT_EQ(file.count("Points"), 0);
  EXPECT_EQ(file.doubles("Points"), Doubles{});
  EXPECT_EQ(file.doubles("normal"), Doubles{});
  EXPECT_EQ(file.indices("offsets"), Indices{});
}

TEST(VtpWriter, ASheetIsPolygonsWithBothNormals) {
  const core::Mesh mesh = {{{0.1, 0, 0}, {1, -0.0, 0}, {0, 1.0 / 3, 0}, {0, 0, 1e-300}},
                           {{0, 1, 2}, {2, 1, 3}}};
  Doubles normals_a, normals_b;
  for (int i = 0; i < 12; ++i) {
    normals_a.push_back(1.0 / (i + 1));
    normals_b.push_back(-0.1 * i);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  std::string bytes;
  ShapeFile sheet = shape_of(mesh);
  sheet.columns = {{"E", false, {1, 2, 1.0 / 3, 4}}, {"strength", false, {0.5, infinity, 0, 5e-324}}};
  for (const auto& [suffix, normals] : {std::pair("_a", normals_a), std::pair("_b", normals_b)}) {
    for (std::size_t c = 0; c < 3; ++c) {
      sheet.columns.push_back({std::string("n") + "xyz"[c] + suffix, false, {}});
      for (std::size_t v = c; v < 12; v += 3) sheet.columns.back().values.push_back(normals[v]);
    }
  }
  write_surface(FileFormat::kVtp, sheet, {"sheet"}, [&](std::string_view piece) { bytes += piece; });
  const VtpFile file(bytes);
  EXPECT_EQ(file.count("Points"), 4);
  EXPECT_EQ(file.count("Verts"), 0);
  EXPECT_EQ(file.count("Lines"), 0);
  EXPECT_EQ(file.count("Strips"), 0);
  EXPECT_EQ(file.count("Polys"), 2);
  EXPECT_EQ(file.doubles("Points"), (Doubles{0.1, 0, 0, 1, -0.0, 0, 0, 1.0 / 3, 0, 0, 0, 1e-300}));
  EXPECT_TRUE(std::signbit(file.doubles("Points")[4]));
  EXPECT_EQ(file.arrays.at("connectivity").section, "Polys");
  EXPECT_EQ(file.indices("connectivity"), (Indices{0, 1, 2, 2, 1, 3}));
  EXPECT_EQ(file.indices("offsets"), (Indices{3, 6}));
  EXPECT_EQ(file.doubles("E"), (Doubles{1, 2, 1.0 / 3, 4}));
  EXPECT_EQ(file.doubles("strength"), (Doubles{0.5, infinity, 0, 5e-324}));
  EXPECT_EQ(file.doubles("normal_a"), normals_a);
  EXPECT_EQ(file.doubles("normal_b"), normals_b);
  EXPECT_EQ(file.arrays.size(), 7u);
}

std::string written_vtp(const ShapeFile& shape) {
  std::string bytes;
  write_shape(FileFormat::kVtp, shape, {}, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

TEST(VtpWriter, ColumnsBecomeArraysOfTheirTypes) {
  ShapeFile shape;
  shape.off.mesh.points = {{0, 0, 0}, {1, 2, 3}};
  shape.columns = {{"big", true, {0, 4294967295.0}},
                   {"n<&\">", true, {-1, 1.5}},
                   {"v_x", false, {1, 2}},
                   {"v_y", false, {3, 4}},
                   {"v_z", false, {5, 6}},
                   {"w_x", false, {1, 2}},
                   {"w_y", false, {3, 4}},
                   {"normal", false, {7, 7}},
                   {"nx", false, {0, 0}},
                   {"ny", false, {0, 0}},
                   {"nz", false, {1, 1}}};
  const VtpFile file(written_vtp(shape));
  EXPECT_EQ(file.numbers<std::uint32_t>("big", "UInt32"), (std::vector<std::uint32_t>{0, 4294967295U}));
  EXPECT_EQ(file.doubles("n&lt;&amp;_&gt;"), (Doubles{-1, 1.5}));
  EXPECT_EQ(file.doubles("v"), (Doubles{1, 3, 5, 2, 4, 6}));
  EXPECT_EQ(file.doubles("w_y"), (Doubles{3, 4}));
  // An array of that name is there already.
  EXPECT_EQ(file.doubles("normal"), (Doubles{7, 7}));
  EXPECT_EQ(file.doubles("nz"), (Doubles{1, 1}));
}

}  // namespace
}  // namespace affskel::client
