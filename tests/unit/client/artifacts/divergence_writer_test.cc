#include "client/artifacts/divergence_writer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "client/base/error.h"
#include "hdf5_reader.h"
#include "sample_data.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

using core::FileFormat;

// H of the sample point of that rank: no two are equal.
double value_of(std::size_t rank) {
  return 9.0 / (double(rank) + 1) - 3;
}

std::string bytes_for(std::uint64_t points) {
  std::string bytes;
  for (std::size_t p = 0; p < points; ++p) {
    const double value = value_of(p);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return bytes;
}

// Writes all points' values, fed in pieces that cut values anywhere.
void write_all(FileFormat format, const std::string& path, const LatticePoints& points) {
  const std::string bytes = bytes_for(points.count());
  constexpr std::size_t kPiece = 29;
  base::AtomicFile file(path);
  DivergenceWriter writer(format, file, points, {{"operator", "sobel"}});
  for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
    writer.data(std::string_view(bytes).substr(at, kPiece));
  }
  writer.finish();
  file.commit();
}

TEST(DivergenceWriter, AnImageReadsBackExactly) {
  const LatticePoints points(lattice_of_slabs());
  const tests::TemporaryDirectory dir;
  write_all(FileFormat::kVtkHdf, dir / "H.vtkhdf", points);
  const hsize_t nx = points.dims()[0] + 2, ny = points.dims()[1] + 2, nz = points.dims()[2] + 2;
  std::vector<double> wanted(nx * ny * nz, std::nan(""));
  std::size_t rank = 0;
  for (LatticeCursor cursor(points); !cursor.at_end(); cursor.advance()) {
    const SamplePoint at = cursor.point();
    wanted[((at.k + 1) * ny + at.j + 1) * nx + at.i + 1] = value_of(rank++);
  }
  const hid_t file = H5Fopen((dir / "H.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const auto divergence = read_array<double>(file, "H", H5T_NATIVE_DOUBLE, {nz, ny, nx});
  const auto inside = read_array<std::uint8_t>(file, "inside", H5T_NATIVE_UINT8, {nz, ny, nx});
  EXPECT_EQ(H5Lexists(file, "/VTKHDF/PointData/E", H5P_DEFAULT), 0);
  H5Fclose(file);
  for (std::size_t cell = 0; cell < wanted.size(); ++cell) {
    const bool outside = std::isnan(wanted[cell]);
    ASSERT_EQ(inside[cell], outside ? 0 : 1) << cell;
    ASSERT_EQ(divergence[cell], outside ? 0 : wanted[cell]) << cell;
  }
}

TEST(DivergenceWriter, AnImageLiesWhereTheFieldsDoes) {
  const LatticePoints points(sample_lattice());
  const tests::TemporaryDirectory dir;
  write_all(FileFormat::kVtkHdf, dir / "H.vtkhdf", points);
  const hid_t file = H5Fopen((dir / "H.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
  EXPECT_EQ(read_attribute<std::int64_t>(root, "WholeExtent", H5T_NATIVE_INT64, 6),
            (std::vector<std::int64_t>{0, 4, 0, 3, 0, 5}));
  EXPECT_EQ(read_attribute<double>(root, "Origin", H5T_NATIVE_DOUBLE, 3),
            (std::vector<double>{0.1 - 1.0 / 3, -2.0 - 1.0 / 3, 1e6 - 1.0 / 3}));
  EXPECT_EQ(read_attribute<double>(root, "Spacing", H5T_NATIVE_DOUBLE, 3), (std::vector<double>(3, 1.0 / 3)));
  H5Gclose(root);
  H5Fclose(file);
}

TEST(DivergenceWriter, TextHasARowPerPoint) {
  const LatticePoints points(sample_lattice());
  const tests::TemporaryDirectory dir;
  write_all(FileFormat::kCsv, dir / "H.csv", points);
  write_all(FileFormat::kDat, dir / "H.dat", points);
  const std::string first = "0.10000000000000001,-2,1000000.3333333334,6\n";
  EXPECT_EQ(tests::read_file(dir / "H.csv").substr(0, 8 + first.size()), "x,y,z,H\n" + first);
  std::string blanks = first;
  for (char& c : blanks) c = c == ',' ? ' ' : c;
  EXPECT_EQ(tests::read_file(dir / "H.dat").substr(0, blanks.size()), blanks);
}

TEST(DivergenceWriter, RefusesTooFewAndTooManyValues) {
  const LatticePoints points(sample_lattice());
  for (const FileFormat format : {FileFormat::kCsv, FileFormat::kVtkHdf}) {
    const tests::TemporaryDirectory dir;
    base::AtomicFile file(dir / "H");
    DivergenceWriter few(format, file, points, {});
    few.data(bytes_for(4));
    EXPECT_THROW(few.finish(), ClientError);
    base::AtomicFile other(dir / "G");
    DivergenceWriter many(format, other, points, {});
    EXPECT_THROW(many.data(bytes_for(6)), ClientError);
  }
}

}  // namespace
}  // namespace affskel::client
