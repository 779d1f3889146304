// Reads the file back with the HDF5 library itself and compares every cell of the lattice.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <map>

#include "client/artifacts/field_writer.h"
#include "core/erosion/outside_erosion.h"
#include "hdf5_reader.h"
#include "sample_data.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

using core::FileFormat;

constexpr double kHdfVolume = 10;

struct Expected {
  std::vector<FieldPoint> points;
  std::array<std::uint32_t, 3> dims;  // of the lattice
};

// What is expected at a place of the grid, which has one layer more than the lattice.
class ExpectedGrid {
 public:
  explicit ExpectedGrid(const Expected& expected, const LatticePoints& points)
      : nx(expected.dims[0] + 2),
        ny(expected.dims[1] + 2),
        nz(expected.dims[2] + 2),
        point(nx * ny * nz, nullptr) {
    for (const FieldPoint& p : expected.points) point[cell(p.i + 1, p.j + 1, p.k + 1)] = &p;
    core::OutsideErosion outside(expected.dims, [&](const core::PlaceAround& at, double value) {
      continued[cell(hsize_t(at[0] + 1), hsize_t(at[1] + 1), hsize_t(at[2] + 1))] = value;
    });
    for (const FieldPoint& p : expected.points) {
      core::Vec3 slopes;
      for (int a = 0; a < 3; ++a)
        (a == 0 ? slopes.x : a == 1 ? slopes.y : slopes.z) = p.slope * dot(p.normal, points.axis(a));
      outside.put({p.i, p.j, p.k}, p.erosion, slopes);
    }
    outside.finish();
  }
  hsize_t cell(hsize_t i, hsize_t j, hsize_t k) const { return (k * ny + j) * nx + i; }
  double erosion(hsize_t at) const {
    if (point[at] != nullptr) return point[at]->erosion;
    const auto found = continued.find(at);
    return found == continued.end() ? 0 : found->second;
  }

  hsize_t nx, ny, nz;
  std::vector<const FieldPoint*> point;  // null outside
  std::map<hsize_t, double> continued;
};

// Compares all arrays of the file with the points, everything else with "outside".
void expect_arrays(const std::string& path, const Expected& expected, const LatticePoints& points) {
  const ExpectedGrid grid(expected, points);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hsize_t nx = grid.nx, ny = grid.ny, nz = grid.nz;
  const auto erosion = read_array<double>(file, "E", H5T_NATIVE_DOUBLE, {nz, ny, nx});
  const auto share = read_array<double>(file, "E_share", H5T_NATIVE_DOUBLE, {nz, ny, nx});
  const auto normal = read_array<double>(file, "normal", H5T_NATIVE_DOUBLE, {nz, ny, nx, 3});
  const auto direction = read_array<std::int32_t>(file, "direction", H5T_NATIVE_INT32, {nz, ny, nx});
  const auto inside = read_array<std::uint8_t>(file, "inside", H5T_NATIVE_UINT8, {nz, ny, nx});
  H5Fclose(file);
  for (std::size_t at = 0; at < erosion.size(); ++at) {
    const FieldPoint* p = grid.point[at];
    ASSERT_EQ(inside[at], p != nullptr ? 1 : 0) << at;
    ASSERT_EQ(direction[at], p != nullptr ? static_cast<std::int32_t>(p->direction) : -1) << at;
    ASSERT_EQ(erosion[at], grid.erosion(at)) << at;
    ASSERT_EQ(share[at], erosion[at] / kHdfVolume) << at;
    for (int c = 0; c < 3; ++c) {
      ASSERT_EQ(normal[3 * at + std::size_t(c)], p != nullptr ? p->normal[c] : 0.0) << at;
    }
  }
}

TEST(VtkHdfWriter, PlacesTheImage) {
  const tests::TemporaryDirectory dir;
  const LatticePoints points(sample_lattice());
  base::AtomicFile out(dir / "f.vtkhdf");
  FieldWriter writer(FileFormat::kVtkHdf, out, points, kHdfVolume, {});
  writer.finish();
  out.commit();
  const hid_t file = H5Fopen((dir / "f.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
  EXPECT_EQ(read_attribute<std::int64_t>(root, "Version", H5T_NATIVE_INT64, 2),
            (std::vector<std::int64_t>{1, 0}));
  EXPECT_EQ(read_attribute<std::int64_t>(root, "WholeExtent", H5T_NATIVE_INT64, 6),
            (std::vector<std::int64_t>{0, 4, 0, 3, 0, 5}));
  EXPECT_EQ(read_attribute<double>(root, "Origin", H5T_NATIVE_DOUBLE, 3),
            (std::vector<double>{0.1 - 1.0 / 3, -2.0 - 1.0 / 3, 1e6 - 1.0 / 3}));
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
  FieldWriter(FileFormat::kVtkHdf, out, points, kHdfVolume, {}).finish();
  out.commit();
  const hid_t file = H5Fopen((dir / "f.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
  const auto origin = read_attribute<double>(root, "Origin", H5T_NATIVE_DOUBLE, 3);
  const auto spacing = read_attribute<double>(root, "Spacing", H5T_NATIVE_DOUBLE, 3);
  const auto direction = read_attribute<double>(root, "Direction", H5T_NATIVE_DOUBLE, 9);
  const core::Vec3 wanted = points.position(2, 1, 3);
  for (std::size_t row = 0; row < 3; ++row) {
    const double place = origin[row] + direction[3 * row] * spacing[0] * 3 +
                         direction[3 * row + 1] * spacing[1] * 2 + direction[3 * row + 2] * spacing[2] * 4;
    EXPECT_NEAR(place, wanted[static_cast<int>(row)], 1e-9);
  }
  // The cell has the volume 1.515625, the frame determinant 1.
  const auto frame = read_attribute<double>(root, "frame_axes", H5T_NATIVE_DOUBLE, 9);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(frame[i] * std::cbrt(1.515625), axes[i], 1e-15);
  H5Gclose(root);
  H5Fclose(file);
}

TEST(VtkHdfWriter, AnUprightImageHasNoFrame) {
  const tests::TemporaryDirectory dir;
  base::AtomicFile out(dir / "f.vtkhdf");
  const LatticePoints points(sample_lattice());
  FieldWriter(FileFormat::kVtkHdf, out, points, kHdfVolume, {}).finish();
  out.commit();
  const hid_t file = H5Fopen((dir / "f.vtkhdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_EQ(H5Aexists_by_name(file, "VTKHDF", "frame_axes", H5P_DEFAULT), 0);
  H5Fclose(file);
}

TEST(VtkHdfWriter, ArraysReadBackExactlyAcrossSlabs) {
  const LatticePoints points(lattice_of_slabs());
  const tests::TemporaryDirectory dir;
  Expected expected{{}, points.dims()};
  base::AtomicFile out(dir / "f.vtkhdf");
  FieldWriter writer(FileFormat::kVtkHdf, out, points, kHdfVolume, {});
  for (LatticeCursor cursor(points); !cursor.at_end(); cursor.advance()) {
    const auto rank = static_cast<std::uint32_t>(expected.points.size());
    const double value = 1.0 / (rank + 1);
    expected.points.push_back({cursor.point(), value, 2 * value, {value, -value, 1}, rank});
    writer.put(expected.points.back());
  }
  ASSERT_EQ(expected.points.size(), points.count());
  writer.finish();
  out.commit();
  expect_arrays(dir / "f.vtkhdf", expected, points);
}

TEST(VtkHdfWriter, SaysWhatItIs) {
  const tests::TemporaryDirectory dir;
  base::AtomicFile out(dir / "f.hdf");
  const LatticePoints points(sample_lattice());
  FieldWriter(FileFormat::kHdf, out, points, kHdfVolume,
              {{"job", "J\xc3\xb6rg"}, {"frame", ""}, {"v0", "2.5", 2.5}})
      .finish();
  out.commit();
  const hid_t file = H5Fopen((dir / "f.hdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t root = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
  EXPECT_EQ(read_attribute<double>(root, "v0", H5T_NATIVE_DOUBLE, 1), std::vector<double>{2.5});
  const hid_t attribute = H5Aopen(root, "job", H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  EXPECT_EQ(H5Tget_cset(type), H5T_CSET_UTF8);
  std::string text(H5Tget_size(type), '?');
  EXPECT_GE(H5Aread(attribute, type, text.data()), 0);
  EXPECT_EQ(text, "J\xc3\xb6rg");
  EXPECT_GT(H5Aexists(root, "frame"), 0);
  H5Tclose(type);
  H5Aclose(attribute);
  H5Gclose(root);
  H5Fclose(file);
}

TEST(VtkHdfWriter, AnAbandonedFileLeavesNothing) {
  const tests::TemporaryDirectory dir;
  {
    const LatticePoints points(sample_lattice());
    base::AtomicFile out(dir / "f.vtkhdf");
    FieldWriter writer(FileFormat::kVtkHdf, out, points, kHdfVolume, {});
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
    FieldWriter(FileFormat::kVtkHdf, out, points, kHdfVolume, {}).finish();
    out.commit();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), tests::read_file(dir / "f.vtkhdf"));
}

// No file of this process may grow beyond that: what a full disk does, without one.
[[noreturn]] void write_without_room(const std::string& target, rlim_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_FSIZE, &limit);
  try {
    base::AtomicFile file(target);
    const LatticePoints points(sample_lattice());
    FieldWriter(FileFormat::kVtkHdf, file, points, kHdfVolume, {}).finish();
  } catch (const base::FileError& error) {
    const bool told = error.code().value() == EFBIG && error.file() == target;
    std::exit(told ? 0 : 1);  // not at once: HDF5 must leave what could not be closed alone
  }
  std::_Exit(2);
}

TEST(VtkHdfWriter, AFullDiskIsALimitThatNamesTheFile) {
  const tests::TemporaryDirectory dir;
  for (const rlim_t bytes : {0, 1000})  // it cannot be begun, or not be closed
    EXPECT_EXIT(write_without_room(dir / "field.vtkhdf", bytes), testing::ExitedWithCode(0), "") << bytes;
}

}  // namespace
}  // namespace affskel::client
