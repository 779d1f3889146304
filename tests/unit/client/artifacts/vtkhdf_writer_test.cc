// Reads the file back with the HDF5 library itself and compares every cell of the lattice.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdlib>

#include "client/artifacts/field_writer.h"
#include "client/base/error.h"
#include "hdf5_reader.h"
#include "sample_data.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

struct Expected {
  std::vector<FieldPoint> points;
  std::array<std::uint32_t, 3> dims;
};

// Compares all arrays of the file with the points, everything else with "outside".
void expect_arrays(const std::string& path, const Expected& expected) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hsize_t nx = expected.dims[0], ny = expected.dims[1], nz = expected.dims[2];
  const auto erosion = read_array<double>(file, "E", H5T_NATIVE_DOUBLE, {nz, ny, nx});
  const auto normal = read_array<double>(file, "normal", H5T_NATIVE_DOUBLE, {nz, ny, nx, 3});
  const auto direction = read_array<std::int32_t>(file, "direction", H5T_NATIVE_INT32, {nz, ny, nx});
  const auto inside = read_array<std::uint8_t>(file, "inside", H5T_NATIVE_UINT8, {nz, ny, nx});
  H5Fclose(file);
  std::vector<const FieldPoint*> at(nx * ny * nz, nullptr);
  for (const FieldPoint& p : expected.points) at[(p.k * ny + p.j) * nx + p.i] = &p;
  for (std::size_t cell = 0; cell < at.size(); ++cell) {
    const FieldPoint* p = at[cell];
    ASSERT_EQ(inside[cell], p != nullptr ? 1 : 0) << cell;
    ASSERT_EQ(direction[cell], p != nullptr ? static_cast<std::int32_t>(p->direction) : -1) << cell;
    if (p == nullptr) {
      ASSERT_TRUE(std::isnan(erosion[cell])) << cell;
    } else {
      ASSERT_EQ(erosion[cell], p->erosion) << cell;
    }
    for (int c = 0; c < 3; ++c) {
      ASSERT_EQ(normal[3 * cell + std::size_t(c)], p != nullptr ? p->normal[c] : 0.0) << cell;
    }
  }
}

TEST(VtkHdfWriter, PlacesTheImage) {
  const tests::TemporaryDirectory dir;
  const LatticePoints points(sample_lattice());
  base::AtomicFile out(dir / "f.vtkhdf");
  FieldWriter writer(FileFormat::kVtkHdf, out, points);
  writer.finish();
  out.commit();
  const hid_t file = H5Fopen((dir / "f.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
  EXPECT_EQ(read_attribute<std::int64_t>(root, "Version", H5T_NATIVE_INT64, 2),
            (std::vector<std::int64_t>{1, 0}));
  EXPECT_EQ(read_attribute<std::int64_t>(root, "WholeExtent", H5T_NATIVE_INT64, 6),
            (std::vector<std::int64_t>{0, 2, 0, 1, 0, 3}));
  EXPECT_EQ(read_attribute<double>(root, "Origin", H5T_NATIVE_DOUBLE, 3),
            (std::vector<double>{0.1, -2.0, 1e6}));
  EXPECT_EQ(read_attribute<double>(root, "Spacing", H5T_NATIVE_DOUBLE, 3), (std::vector<double>(3, 1.0 / 3)));
  EXPECT_EQ(read_attribute<double>(root, "Direction", H5T_NATIVE_DOUBLE, 9),
            (std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  const hid_t type_attribute = H5Aopen(root, "Type", H5P_DEFAULT);
  const hid_t type = H5Aget_type(type_attribute);
  EXPECT_EQ(H5Tget_class(type), H5T_STRING);
  EXPECT_EQ(H5Tis_variable_str(type), 0);
  EXPECT_EQ(H5Tget_cset(type), H5T_CSET_ASCII);
  std::string text(H5Tget_size(type), '?');
  EXPECT_GE(H5Aread(type_attribute, type, text.data()), 0);
  EXPECT_EQ(text, "ImageData");
  H5Tclose(type);
  H5Aclose(type_attribute);
  H5Gclose(root);
  H5Fclose(file);
}

// Index to place, as VTK does it.
TEST(VtkHdfWriter, PlacesAShearedImage) {
  v1::Lattice lattice = sample_lattice();
  const std::array<double, 9> axes = {2, 0, 0.5, 0.25, 1, 0, -1, 0.125, 0.5};
  for (int i = 0; i < 9; ++i) lattice.set_axes(i, axes[static_cast<std::size_t>(i)]);
  const LatticePoints points(lattice);
  const tests::TemporaryDirectory dir;
  base::AtomicFile out(dir / "f.vtkhdf");
  FieldWriter(FileFormat::kVtkHdf, out, points).finish();
  out.commit();
  const hid_t file = H5Fopen((dir / "f.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
  const auto origin = read_attribute<double>(root, "Origin", H5T_NATIVE_DOUBLE, 3);
  const auto spacing = read_attribute<double>(root, "Spacing", H5T_NATIVE_DOUBLE, 3);
  const auto direction = read_attribute<double>(root, "Direction", H5T_NATIVE_DOUBLE, 9);
  const core::Vec3 wanted = points.position(2, 1, 3);
  for (std::size_t row = 0; row < 3; ++row) {
    const double place = origin[row] + direction[3 * row] * spacing[0] * 2 +
                         direction[3 * row + 1] * spacing[1] * 1 + direction[3 * row + 2] * spacing[2] * 3;
    EXPECT_NEAR(place, wanted[static_cast<int>(row)], 1e-9);
  }
  // The cell has the volume 1.515625, the frame determinant 1.
  const auto frame = read_attribute<double>(root, "frame", H5T_NATIVE_DOUBLE, 9);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(frame[i] * std::cbrt(1.515625), axes[i], 1e-15);
  H5Gclose(root);
  H5Fclose(file);
}

TEST(VtkHdfWriter, AnUprightImageHasNoFrame) {
  const tests::TemporaryDirectory dir;
  base::AtomicFile out(dir / "f.vtkhdf");
  const LatticePoints points(sample_lattice());
  FieldWriter(FileFormat::kVtkHdf, out, points).finish();
  out.commit();
  const hid_t file = H5Fopen((dir / "f.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_EQ(H5Aexists_by_name(file, "VTKHDF", "frame", H5P_DEFAULT), 0);
  H5Fclose(file);
}

TEST(VtkHdfWriter, ArraysReadBackExactlyAcrossSlabs) {
  const LatticePoints points(lattice_of_slabs());
  const tests::TemporaryDirectory dir;
  Expected expected{{}, points.dims()};
  base::AtomicFile out(dir / "f.vtkhdf");
  FieldWriter writer(FileFormat::kVtkHdf, out, points);
  for (LatticeCursor cursor(points); !cursor.at_end(); cursor.advance()) {
    const auto rank = static_cast<std::uint32_t>(expected.points.size());
    const double value = 1.0 / (rank + 1);
    expected.points.push_back({cursor.point(), value, {value, -value, 1}, rank});
    writer.put(expected.points.back());
  }
  ASSERT_EQ(expected.points.size(), points.count());
  writer.finish();
  out.commit();
  expect_arrays(dir / "f.vtkhdf", expected);
}

TEST(VtkHdfWriter, AnAbandonedFileLeavesNothing) {
  const tests::TemporaryDirectory dir;
  {
    const LatticePoints points(sample_lattice());
    base::AtomicFile out(dir / "f.vtkhdf");
    FieldWriter writer(FileFormat::kVtkHdf, out, points);
    writer.put({});
  }
  EXPECT_TRUE(dir.names().empty());
}

TEST(VtkHdfWriter, GoesThroughAPipeAsItIs) {
  const LatticePoints points(sample_lattice());
  const tests::TemporaryDirectory dir;
  ::testing::internal::CaptureStdout();
  for (const std::string& target : {dir / "f.vtkhdf", std::string("-")}) {
    base::AtomicFile out(target);
    FieldWriter(FileFormat::kVtkHdf, out, points).finish();
    out.commit();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), tests::read_file(dir / "f.vtkhdf"));
}

// No file of this process may grow: what a full disk does, without one.
[[noreturn]] void write_without_room(const std::string& target) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_FSIZE, &none);
  try {
    base::AtomicFile file(target);
    const LatticePoints points(sample_lattice());
    FieldWriter(FileFormat::kVtkHdf, file, points).finish();
  } catch (const ClientError& error) {
    const bool told = error.exit_code() == ExitCode::kLimit && error.file() == target;
    std::_Exit(told ? 0 : 1);
  }
  std::_Exit(2);
}

TEST(VtkHdfWriter, AFullDiskIsALimitThatNamesTheFile) {
  const tests::TemporaryDirectory dir;
  EXPECT_EXIT(write_without_room(dir / "field.vtkhdf"), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace affskel::client
