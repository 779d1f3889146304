#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/atomic_file.h"
#include "client/base/lattice_points.h"

namespace affskel::client {

/// The planes of constant x of an image that are held in memory.
struct VtkHdfSlab {
  std::array<std::uint32_t, 3> dims{};  ///< of the lattice
  std::uint32_t first_x = 0;
  std::uint32_t width = 0;  ///< number of planes
};

/// What an image asks of its arrays, whatever their type.
class VtkHdfArrayBase {
 public:
  virtual ~VtkHdfArrayBase() = default;
  /// Writes the planes of the slab and fills them with the value of outside.
  virtual void write() = 0;
};

/// One array over the lattice: `components` values per point, kept for one slab.
template <typename T>
class VtkHdfArray : public VtkHdfArrayBase {
 public:
  /// Component c at lattice point (i, j, k); i must be of the image's slab.
  T& at(std::uint32_t i, std::uint32_t j, std::uint32_t k, unsigned c = 0) {
    const std::size_t row = std::size_t{k} * slab_.dims[1] + j;
    return values_[(row * slab_.width + (i - slab_.first_x)) * components_ + c];
  }

 protected:
  VtkHdfArray(const VtkHdfSlab& slab, unsigned components) : slab_(slab), components_(components) {}

  const VtkHdfSlab& slab_;
  unsigned components_;
  std::vector<T> values_;
};

/// A VTKHDF file of ImageData (version 1.0) that is written plane by plane: places by WholeExtent, Origin,
/// Spacing and Direction (and `frame` where the lattice is not upright), PointData datasets with dimensions
/// in the order z, y, x.  Holds eight planes of constant x at a time.  All members throw ClientError naming
/// the file: kNotFound for a lattice without points, kLimit for a full disk.
class VtkHdfImage {
 public:
  /// `file` must outlive it.
  VtkHdfImage(base::AtomicFile& file, const LatticePoints& points);
  ~VtkHdfImage();
  VtkHdfImage(const VtkHdfImage&) = delete;
  VtkHdfImage& operator=(const VtkHdfImage&) = delete;

  /// Adds an array of T = double, std::int32_t or std::uint8_t; all before the first `enter`.  Points that
  /// get no value have `outside`.
  template <typename T>
  VtkHdfArray<T>& add(const char* name, unsigned components, T outside);

  /// Brings plane i into the slab.  Planes come in ascending order.
  void enter(std::uint32_t i);

  /// Writes what is left; call once, last.  The file is left uncommitted.
  void finish();

 private:
  struct Open;
  void next_slab();

  base::AtomicFile& file_;
  VtkHdfSlab slab_;
  std::unique_ptr<Open> open_;
};

}  // namespace affskel::client
