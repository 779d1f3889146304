// The VTKHDF file format, ImageData, version 1.0: a group VTKHDF with attributes that place the image and
// a group PointData with one dataset per array.  VTK's x is fastest, so dataset dimensions are (z, y, x)
// while the points arrive with x slowest: planes of constant x are collected in slabs as thick as a chunk.
//
// Point (i, j, k) lies at Origin + Direction (Spacing * (i, j, k)), Direction's columns being the unit
// vectors along the lattice's axes.  Of an affine frame these are not orthogonal; VTK's image data applies
// and inverts the matrix as it stands, so that places, cells and isosurfaces are right all the same (tried
// with 9.1, whose reader of these files only keeps the matrix, turned or sheared, without using it until
// SetDirectionMatrix is called with it).  The attribute "frame", 9 numbers, one vector of the frame after the
// other, says that a lattice is not parallel to the mesh's axes: then whoever takes Origin and Spacing alone
// gets wrong places.  It is an attribute because VTK 9.1 refuses images with a FieldData group.
#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <limits>

#include "client/error.h"
#include "client/exporters/field_writer.h"
#include "core/matrix3.h"

namespace affskel::client {
namespace {

constexpr std::uint32_t kSlab = 8;  // planes of constant x per slab; a chunk is kSlab thick in x
constexpr hsize_t kChunk = 32;      // edge of a chunk in y and z
constexpr unsigned kCompression = 4;

// What failed, and why as far as the system told: HDF5 leaves errno as the failed call set it.
ClientError hdf5_error(const std::string& what) {
  const std::string action = "HDF5 failed: " + what;
  for (const int cause : {ENOSPC, EDQUOT, EFBIG, EIO, EROFS, EACCES, EPERM}) {
    if (errno == cause) return error_from_errno(cause, action, "", ExitCode::kInternal);
  }
  return {ExitCode::kInternal, action};
}

// An HDF5 identifier with its closing function.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const char* what) : id_(id), close_(close) {
    if (id_ < 0) throw hdf5_error(what);
  }
  ~Handle() { release(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  herr_t release() {
    const hid_t id = id_;
    id_ = -1;
    return id < 0 ? 0 : close_(id);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

// HDF5 prints its error stack by default; ours go through ClientError.
void silence_hdf5() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

template <std::size_t N, typename T>
void set_attribute(hid_t group, const char* name, const std::array<T, N>& values) {
  const bool real = std::is_floating_point_v<T>;
  const hsize_t size = N;
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, name);
  const Handle attribute(
      H5Acreate2(group, name, real ? H5T_IEEE_F64LE : H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, name);
  const hid_t memory = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  if (H5Awrite(attribute, memory, values.data()) < 0) throw hdf5_error("attribute");
}

void set_text_attribute(hid_t group, const char* name, std::string_view text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, name);
  H5Tset_size(type, text.size());
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_ASCII);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, name);
  const Handle attribute(H5Acreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
  if (H5Awrite(attribute, type, text.data()) < 0) throw hdf5_error("attribute");
}

// One array over the lattice: `components` values per point, kept for one slab.
template <typename T>
class Array {
 public:
  Array(hid_t group, const char* name, hid_t file_type, hid_t memory_type,
        const std::array<std::uint32_t, 3>& dims, hsize_t components, T outside)
      : memory_type_(memory_type),
        dims_(dims),
        components_(components),
        outside_(outside),
        dataset_(create(group, name, file_type), H5Dclose, name) {
    slab_.assign(std::size_t{kSlab} * dims[1] * dims[2] * components, outside);
  }

  // Value of component c at (x, y, z), x counted from the slab's first plane of `width` planes.
  T& at(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t width, hsize_t c = 0) {
    return slab_[((std::size_t{z} * dims_[1] + y) * width + x) * components_ + c];
  }

  void write(std::uint32_t first_x, std::uint32_t width) {
    const std::array<hsize_t, 4> start = {0, 0, first_x, 0};
    const std::array<hsize_t, 4> count = {dims_[2], dims_[1], width, components_};
    const Handle file_space(H5Dget_space(dataset_), H5Sclose, "dataspace");
    const Handle memory_space(H5Screate_simple(rank(), count.data(), nullptr), H5Sclose, "dataspace");
    if (H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dwrite(dataset_, memory_type_, memory_space, file_space, H5P_DEFAULT, slab_.data()) < 0) {
      throw hdf5_error("cannot write");
    }
    std::fill(slab_.begin(), slab_.end(), outside_);
  }

 private:
  int rank() const { return components_ > 1 ? 4 : 3; }

  hid_t create(hid_t group, const char* name, hid_t file_type) const {
    const std::array<hsize_t, 4> size = {dims_[2], dims_[1], dims_[0], components_};
    const std::array<hsize_t, 4> chunk = {std::min<hsize_t>(kChunk, dims_[2]),
                                          std::min<hsize_t>(kChunk, dims_[1]),
                                          std::min<hsize_t>(kSlab, dims_[0]), components_};
    const Handle space(H5Screate_simple(rank(), size.data(), nullptr), H5Sclose, name);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
    H5Pset_chunk(properties, rank(), chunk.data());
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, kCompression);
    H5Pset_obj_track_times(properties, false);  // equal fields are equal files
    return H5Dcreate2(group, name, file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  }

  hid_t memory_type_;
  std::array<std::uint32_t, 3> dims_;
  hsize_t components_;
  T outside_;
  Handle dataset_;
  std::vector<T> slab_;
};

// Everything that is open while a file is written.
struct OpenFile {
  OpenFile(const std::string& path, const std::array<std::uint32_t, 3>& dims)
      : file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
             "cannot create the file"),
        root(H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group"),
        points(H5Gcreate2(root, "PointData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group"),
        erosion(points, "E", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, dims, 1,
                std::numeric_limits<double>::quiet_NaN()),
        normal(points, "normal", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, dims, 3, 0.0),
        direction(points, "direction", H5T_STD_I32LE, H5T_NATIVE_INT32, dims, 1, -1),
        inside(points, "inside", H5T_STD_U8LE, H5T_NATIVE_UINT8, dims, 1, 0) {}

  Handle file, root, points;
  Array<double> erosion, normal;
  Array<std::int32_t> direction;
  Array<std::uint8_t> inside;
};

class VtkHdfWriter : public FieldWriter {
 public:
  VtkHdfWriter(AtomicFile& file, const LatticePoints& points) : file_(file), dims_(points.dims()) {
    if (!file.is_regular()) {
      throw ClientError(ExitCode::kUsage, "HDF5 can only be written to a regular file", file.target());
    }
    if (points.count() == 0) throw ClientError(ExitCode::kNotFound, "the field has no points");
    silence_hdf5();
    with_place([&] {
      open_ = std::make_unique<OpenFile>(file.path(), dims_);
      place(points);
    });
  }

  void put(const FieldPoint& p) override {
    if (p.i >= first_x_ + width()) {
      with_place([&] {
        while (p.i >= first_x_ + width()) flush_slab();
      });
    }
    const std::uint32_t x = p.i - first_x_;
    open_->erosion.at(x, p.j, p.k, width()) = p.erosion;
    open_->direction.at(x, p.j, p.k, width()) = static_cast<std::int32_t>(p.direction);
    open_->inside.at(x, p.j, p.k, width()) = 1;
    for (int c = 0; c < 3; ++c) {
      open_->normal.at(x, p.j, p.k, width(), static_cast<hsize_t>(c)) = p.normal[c];
    }
  }

  void finish() override {
    with_place([&] {
      while (first_x_ < dims_[0]) flush_slab();
      const hid_t id = open_->file;
      if (H5Fflush(id, H5F_SCOPE_GLOBAL) < 0) throw hdf5_error("cannot write");
      open_.reset();
    });
  }

 private:
  // Errors name the file that was asked for, not the temporary one.
  template <typename Action>
  void with_place(Action&& action) {
    errno = 0;
    try {
      action();
    } catch (const ClientError& error) {
      throw ClientError(error.exit_code(), error.what(), file_.target());
    }
  }

  std::uint32_t width() const { return std::min(kSlab, dims_[0] - first_x_); }

  void flush_slab() {
    const std::uint32_t planes = width();
    open_->erosion.write(first_x_, planes);
    open_->normal.write(first_x_, planes);
    open_->direction.write(first_x_, planes);
    open_->inside.write(first_x_, planes);
    first_x_ += planes;
  }

  void place(const LatticePoints& points) {
    const hid_t root = open_->root;
    set_attribute(root, "Version", std::array<std::int64_t, 2>{1, 0});
    set_text_attribute(root, "Type", "ImageData");
    set_attribute(root, "WholeExtent",
                  std::array<std::int64_t, 6>{0, std::int64_t{dims_[0]} - 1, 0, std::int64_t{dims_[1]} - 1, 0,
                                              std::int64_t{dims_[2]} - 1});
    const core::Vec3& o = points.origin();
    set_attribute(root, "Origin", std::array<double, 3>{o.x, o.y, o.z});
    std::array<double, 3> spacing{};
    std::array<double, 9> direction{};  // row by row; column a is the direction of lattice axis a
    for (std::size_t a = 0; a < 3; ++a) {
      const core::Vec3& axis = points.axis(static_cast<int>(a));
      spacing[a] = core::norm(axis);
      for (std::size_t row = 0; row < 3; ++row) {
        direction[3 * row + a] = axis[static_cast<int>(row)] / spacing[a];
      }
    }
    set_attribute(root, "Spacing", spacing);
    set_attribute(root, "Direction", direction);
    if (!is_upright(points)) write_frame(points);
  }

  static bool is_upright(const LatticePoints& points) {
    const core::Vec3 &x = points.axis(0), &y = points.axis(1), &z = points.axis(2);
    return x.y == 0 && x.z == 0 && y.x == 0 && y.z == 0 && z.x == 0 && z.y == 0 && x.x == y.y && y.y == z.z;
  }

  // The axes divided by the lattice's spacing, the cube root of the cell's volume.
  void write_frame(const LatticePoints& points) {
    const core::Matrix3 axes = {points.axis(0), points.axis(1), points.axis(2)};
    const double spacing = std::cbrt(std::abs(core::determinant(axes)));
    std::array<double, 9> frame{};
    for (std::size_t i = 0; i < 9; ++i) frame[i] = axes[i / 3][static_cast<int>(i % 3)] / spacing;
    set_attribute(open_->root, "frame", frame);
  }

  AtomicFile& file_;
  std::array<std::uint32_t, 3> dims_;
  std::unique_ptr<OpenFile> open_;
  std::uint32_t first_x_ = 0;
};

}  // namespace

std::unique_ptr<FieldWriter> make_vtkhdf_writer(AtomicFile& file, const LatticePoints& points) {
  return std::make_unique<VtkHdfWriter>(file, points);
}

}  // namespace affskel::client
