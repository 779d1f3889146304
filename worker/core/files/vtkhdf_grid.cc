// The VTKHDF file format, ImageData, version 1.0: a group VTKHDF with attributes that place the image and
// a group PointData with one dataset per array.  VTK's x is fastest, so dataset dimensions are (z, y, x)
// while the points arrive with x slowest: planes of constant x are collected in slabs as thick as a chunk.
//
// Point (i, j, k) lies at Origin + Direction (Spacing * (i, j, k)), Direction's columns being the unit
// vectors along the lattice's axes.  Of an affine frame these are not orthogonal; VTK's image data applies
// and inverts the matrix as it stands, so that grid, cells and isosurfaces are right all the same.  (Tried
// with 9.1, whose reader keeps the matrix but does not use it until SetDirectionMatrix is called with it.)
// The attribute "frame_axes" marks a lattice that is not parallel to the mesh's axes, whose places do not
// follow from Origin and Spacing alone: 9 numbers, one vector of the frame after the other.  It is an
// attribute because VTK 9.1 refuses images with a FieldData group.
#include "core/files/vtkhdf_grid.h"

#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include "core/lattice/lattice_coordinates.h"

#include "core/base/error.h"
#include "core/base/matrix3.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kSlab = 8;  // planes of constant x written at a time; a chunk is as thick in x
constexpr hsize_t kChunk = 32;      // edge of a chunk in y and z
constexpr unsigned kDeflation = 4;

// What failed in HDF5, with the cause in errno, which it leaves as the failed system call set it.
struct Hdf5Error {
  std::string action;
  int error_number;
};

[[noreturn]] void hdf5_failed(const std::string& what) {
  throw Hdf5Error{"HDF5 failed: " + what, errno};
}

// An HDF5 identifier with its closing function.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const char* what) : id_(id), close_(close) {
    if (id_ < 0) hdf5_failed(what);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

template <std::size_t N, typename T>
void set_attribute(hid_t group, const char* name, const std::array<T, N>& values) {
  const bool real = std::is_floating_point_v<T>;
  const hsize_t size = N;
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, name);
  const Handle attribute(
      H5Acreate2(group, name, real ? H5T_IEEE_F64LE : H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, name);
  const hid_t memory = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  if (H5Awrite(attribute, memory, values.data()) < 0) hdf5_failed("attribute");
}

void set_text_attribute(hid_t group, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, name);
  const bool ascii =
      std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
  H5Tset_size(type, std::max<std::size_t>(1, text.size()));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
  const Handle attribute(H5Acreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  if (H5Awrite(attribute, type, text.data()) < 0) hdf5_failed("attribute");
}

// A file whose last bytes find no room cannot be closed.  Its identifier stays behind, and HDF5 would close it again
// when the process ends, by what is freed then.
void leave_no_work_for_the_end() {
  [[maybe_unused]] static const herr_t once = H5dont_atexit();  // heeded only before all other calls
}

// The types of arrays as they are stored; in memory all are converted from double.
hid_t stored_type(GridType type) {
  return type == GridType::kFloat64 ? H5T_IEEE_F64LE
         : type == GridType::kInt32 ? H5T_STD_I32LE
                                    : H5T_STD_U8LE;
}

// The axes divided by the lattice's spacing, the cube root of the cell's volume.
void write_frame(hid_t root, const LatticeGrid& grid) {
  const Matrix3 axes = grid.axes;
  const double spacing = std::cbrt(std::abs(determinant(axes)));
  std::array<double, 9> frame{};
  for (std::size_t i = 0; i < 9; ++i) frame[i] = axes[i / 3][i % 3] / spacing;
  set_attribute(root, "frame_axes", frame);
}

// Where the points of the image are.
void place(hid_t root, const LatticeGrid& grid) {
  const std::array<std::uint32_t, 3>& dims = grid.dims;
  set_attribute(root, "Version", std::array<std::int64_t, 2>{1, 0});
  set_text_attribute(root, "Type", "ImageData");
  set_attribute(root, "WholeExtent",
                std::array<std::int64_t, 6>{0, std::int64_t{dims[0]} - 1, 0, std::int64_t{dims[1]} - 1, 0,
                                            std::int64_t{dims[2]} - 1});
  const Vec3& o = grid.origin;
  set_attribute(root, "Origin", std::array<double, 3>{o.x, o.y, o.z});
  std::array<double, 3> spacing{};
  std::array<double, 9> direction{};  // row by row; column a is the direction of lattice axis a
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3& axis = grid.axes[a];
    spacing[a] = norm(axis);
    for (std::size_t row = 0; row < 3; ++row) {
      direction[3 * row + a] = axis[row] / spacing[a];
    }
  }
  set_attribute(root, "Spacing", spacing);
  set_attribute(root, "Direction", direction);
  if (!is_cubic(grid)) write_frame(root, grid);
}

class VtkHdfGrid : public GridFile {
 public:
  VtkHdfGrid(base::AtomicFile& file, const LatticeGrid& grid, std::vector<GridArray> arrays,
             const FileFacts& facts)
      : out_(file), dims_(grid.dims), arrays_(std::move(arrays)) {
    leave_no_work_for_the_end();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it prints its error stack by default; ours are thrown
    guarded([&] {
      open_ = std::make_unique<Open>(file.path());
      place(open_->root, grid);
      for (const FileFact& fact : facts) write_fact(fact);
      for (const GridArray& array : arrays_) open_->datasets.push_back(create(array));
    });
  }

  std::uint32_t planes_at_a_time() const override { return kSlab; }
  std::uint32_t overlap() const override { return 0; }

  void write(const GridPlanes& planes, std::uint32_t begin, std::uint32_t end) override {
    guarded([&] {
      for (std::size_t a = 0; a < arrays_.size(); ++a) {
        values_.clear();
        for_each_value(arrays_[a], dims_, planes, begin, end,
                       [&](double value) { values_.push_back(value); });
        write_values(arrays_[a], *open_->datasets[a], begin, end);
      }
    });
  }

  void finish() override {
    guarded([&] {
      if (H5Fflush(open_->file, H5F_SCOPE_GLOBAL) < 0) hdf5_failed("cannot write");
      open_.reset();
    });
  }

 private:
  // Everything that is open while the file is written.
  struct Open {
    explicit Open(const std::string& path)
        : file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
               "cannot create the file"),
          root(H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group"),
          points(H5Gcreate2(root, "PointData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group") {}

    Handle file, root, points;
    std::vector<std::unique_ptr<Handle>> datasets;
  };

  // Errors name the file that was asked for, not the temporary one.
  template <typename Action>
  void guarded(Action action) {
    errno = 0;
    try {
      action();
    } catch (const Hdf5Error& error) {
      for (const int cause : {ENOSPC, EDQUOT, EFBIG, EIO, EROFS, EACCES, EPERM}) {
        if (error.error_number == cause) throw base::FileError(cause, error.action, out_.target());
      }
      throw CoreError(CoreError::Code::kInternal, out_.target().string() + ": " + error.action);
    }
  }

  void write_fact(const FileFact& fact) {
    if (fact.number) return set_attribute(open_->root, fact.key.c_str(), std::array<double, 1>{*fact.number});
    set_text_attribute(open_->root, fact.key.c_str(), fact.text);
  }

  static int rank(const GridArray& array) { return array.components > 1 ? 4 : 3; }

  std::unique_ptr<Handle> create(const GridArray& array) const {
    const char* name = array.name.c_str();
    const std::array<hsize_t, 4> size = {dims_[2], dims_[1], dims_[0], array.components};
    const std::array<hsize_t, 4> chunk = {std::min<hsize_t>(kChunk, dims_[2]),
                                          std::min<hsize_t>(kChunk, dims_[1]),
                                          std::min<hsize_t>(kSlab, dims_[0]), array.components};
    const Handle space(H5Screate_simple(rank(array), size.data(), nullptr), H5Sclose, name);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
    H5Pset_chunk(properties, rank(array), chunk.data());
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, kDeflation);
    H5Pset_obj_track_times(properties, false);  // equal fields are equal files
    return std::make_unique<Handle>(
        H5Dcreate2(open_->points, name, stored_type(array.type), space, H5P_DEFAULT, properties, H5P_DEFAULT),
        H5Dclose, name);
  }

  // values_ into the planes [begin, end) of a dataset.
  void write_values(const GridArray& array, hid_t dataset, std::uint32_t begin, std::uint32_t end) const {
    const std::array<hsize_t, 4> start = {0, 0, begin, 0};
    const std::array<hsize_t, 4> count = {dims_[2], dims_[1], end - begin, array.components};
    const Handle file_space(H5Dget_space(dataset), H5Sclose, "dataspace");
    const Handle memory_space(H5Screate_simple(rank(array), count.data(), nullptr), H5Sclose, "dataspace");
    if (H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory_space, file_space, H5P_DEFAULT, values_.data()) < 0) {
      hdf5_failed("cannot write");
    }
  }

  base::AtomicFile& out_;
  std::array<std::uint32_t, 3> dims_;
  std::vector<GridArray> arrays_;
  std::unique_ptr<Open> open_;
  std::vector<double> values_;  // of the array in hand
};

}  // namespace

std::unique_ptr<GridFile> make_vtkhdf_grid(base::AtomicFile& file, const LatticeGrid& grid,
                                           std::vector<GridArray> arrays, const FileFacts& facts) {
  return std::make_unique<VtkHdfGrid>(file, grid, std::move(arrays), facts);
}

}  // namespace affskel::core
