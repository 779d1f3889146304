// The VTKHDF file format, ImageData, version 1.0: a group VTKHDF with attributes that place the image and
// a group PointData with one dataset per array.  VTK's x is fastest, so dataset dimensions are (z, y, x)
// while the points arrive with x slowest: planes of constant x are collected in slabs as thick as a chunk.
//
// Point (i, j, k) lies at Origin + Direction (Spacing * (i, j, k)), Direction's columns being the unit
// vectors along the lattice's axes.  Of an affine frame these are not orthogonal; VTK's image data applies
// and inverts the matrix as it stands, so that places, cells and isosurfaces are right all the same.  (Tried
// with 9.1, whose reader keeps the matrix but does not use it until SetDirectionMatrix is called with it.)
// The attribute "frame" marks a lattice that is not parallel to the mesh's axes, whose places do not follow
// from Origin and Spacing alone: 9 numbers, one vector of the frame after the other.  It is an attribute
// because VTK 9.1 refuses images with a FieldData group.
#include "client/files/write/vtkhdf_image.h"

#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "client/base/error.h"
#include "core/base/matrix3.h"

namespace affskel::client {
namespace {

constexpr std::uint32_t kSlab = 8;  // planes of constant x per slab; a chunk is kSlab thick in x
constexpr hsize_t kChunk = 32;      // edge of a chunk in y and z
constexpr unsigned kCompression = 4;

// What failed, with the cause in errno, which HDF5 leaves as the failed system call set it.
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

// The types of arrays: as they are stored, and as they are in memory.
struct Types {
  hid_t file, memory;
};
Types types_of(double) {
  return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
}
Types types_of(std::int32_t) {
  return {H5T_STD_I32LE, H5T_NATIVE_INT32};
}
Types types_of(std::uint8_t) {
  return {H5T_STD_U8LE, H5T_NATIVE_UINT8};
}

template <typename T>
class Array : public VtkHdfArray<T> {
 public:
  Array(hid_t group, const char* name, const VtkHdfSlab& slab, unsigned components, T outside)
      : VtkHdfArray<T>(slab, components), outside_(outside), dataset_(create(group, name), H5Dclose, name) {
    this->values_.assign(std::size_t{kSlab} * slab.dims[1] * slab.dims[2] * components, outside);
  }

  void write() override {
    const auto& [dims, first_x, width] = this->slab_;
    const std::array<hsize_t, 4> start = {0, 0, first_x, 0};
    const std::array<hsize_t, 4> count = {dims[2], dims[1], width, this->components_};
    const Handle file_space(H5Dget_space(dataset_), H5Sclose, "dataspace");
    const Handle memory_space(H5Screate_simple(rank(), count.data(), nullptr), H5Sclose, "dataspace");
    if (H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dwrite(dataset_, types_of(T{}).memory, memory_space, file_space, H5P_DEFAULT,
                 this->values_.data()) < 0) {
      throw hdf5_error("cannot write");
    }
    std::fill(this->values_.begin(), this->values_.end(), outside_);
  }

 private:
  int rank() const { return this->components_ > 1 ? 4 : 3; }

  hid_t create(hid_t group, const char* name) const {
    const std::array<std::uint32_t, 3>& dims = this->slab_.dims;
    const std::array<hsize_t, 4> size = {dims[2], dims[1], dims[0], this->components_};
    const std::array<hsize_t, 4> chunk = {std::min<hsize_t>(kChunk, dims[2]),
                                          std::min<hsize_t>(kChunk, dims[1]),
                                          std::min<hsize_t>(kSlab, dims[0]), this->components_};
    const Handle space(H5Screate_simple(rank(), size.data(), nullptr), H5Sclose, name);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
    H5Pset_chunk(properties, rank(), chunk.data());
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, kCompression);
    H5Pset_obj_track_times(properties, false);  // equal fields are equal files
    return H5Dcreate2(group, name, types_of(T{}).file, space, H5P_DEFAULT, properties, H5P_DEFAULT);
  }

  T outside_;
  Handle dataset_;
};

bool is_upright(const LatticePoints& points) {
  const core::Vec3 &x = points.axis(0), &y = points.axis(1), &z = points.axis(2);
  return x.y == 0 && x.z == 0 && y.x == 0 && y.z == 0 && z.x == 0 && z.y == 0 && x.x == y.y && y.y == z.z;
}

// The axes divided by the lattice's spacing, the cube root of the cell's volume.
void write_frame(hid_t root, const LatticePoints& points) {
  const core::Matrix3 axes = {points.axis(0), points.axis(1), points.axis(2)};
  const double spacing = std::cbrt(std::abs(core::determinant(axes)));
  std::array<double, 9> frame{};
  for (std::size_t i = 0; i < 9; ++i) frame[i] = axes[i / 3][static_cast<int>(i % 3)] / spacing;
  set_attribute(root, "frame", frame);
}

// Where the points of the image are.
void place(hid_t root, const LatticePoints& points) {
  const std::array<std::uint32_t, 3>& dims = points.dims();
  set_attribute(root, "Version", std::array<std::int64_t, 2>{1, 0});
  set_text_attribute(root, "Type", "ImageData");
  set_attribute(root, "WholeExtent",
                std::array<std::int64_t, 6>{0, std::int64_t{dims[0]} - 1, 0, std::int64_t{dims[1]} - 1, 0,
                                            std::int64_t{dims[2]} - 1});
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
  if (!is_upright(points)) write_frame(root, points);
}

// Errors name the file that was asked for, not the temporary one.
template <typename Action>
void with_place(const base::AtomicFile& file, Action&& action) {
  errno = 0;
  try {
    action();
  } catch (const ClientError& error) {
    throw ClientError(error.exit_code(), error.what(), file.target());
  }
}

}  // namespace

// Everything that is open while a file is written.
struct VtkHdfImage::Open {
  explicit Open(const std::string& path)
      : file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
             "cannot create the file"),
        root(H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group"),
        points(H5Gcreate2(root, "PointData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "group") {}

  Handle file, root, points;
  std::vector<std::unique_ptr<VtkHdfArrayBase>> arrays;
};

VtkHdfImage::VtkHdfImage(base::AtomicFile& file, const LatticePoints& points) : file_(file) {
  if (points.count() == 0) throw ClientError(ExitCode::kNotFound, "the field has no points", file.target());
  slab_.dims = points.dims();
  slab_.width = std::min(kSlab, slab_.dims[0]);
  silence_hdf5();
  with_place(file_, [&] {
    open_ = std::make_unique<Open>(file.path());
    place(open_->root, points);
  });
}

VtkHdfImage::~VtkHdfImage() = default;

template <typename T>
VtkHdfArray<T>& VtkHdfImage::add(const char* name, unsigned components, T outside) {
  std::unique_ptr<Array<T>> array;
  with_place(file_,
             [&] { array = std::make_unique<Array<T>>(open_->points, name, slab_, components, outside); });
  VtkHdfArray<T>& added = *array;
  open_->arrays.push_back(std::move(array));
  return added;
}

template VtkHdfArray<double>& VtkHdfImage::add(const char*, unsigned, double);
template VtkHdfArray<std::int32_t>& VtkHdfImage::add(const char*, unsigned, std::int32_t);
template VtkHdfArray<std::uint8_t>& VtkHdfImage::add(const char*, unsigned, std::uint8_t);

void VtkHdfImage::next_slab() {
  for (const auto& array : open_->arrays) array->write();
  slab_.first_x += slab_.width;
  slab_.width = std::min(kSlab, slab_.dims[0] - slab_.first_x);
}

void VtkHdfImage::enter(std::uint32_t i) {
  if (i < slab_.first_x + slab_.width) return;
  with_place(file_, [&] {
    while (i >= slab_.first_x + slab_.width) next_slab();
  });
}

void VtkHdfImage::finish() {
  with_place(file_, [&] {
    while (slab_.first_x < slab_.dims[0]) next_slab();
    if (H5Fflush(open_->file, H5F_SCOPE_GLOBAL) < 0) throw hdf5_error("cannot write");
    open_.reset();
  });
}

}  // namespace affskel::client
