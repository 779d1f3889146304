#pragma once

#include <cstdint>
#include <memory>

#include "affskel/v1/types.pb.h"
#include "client/artifacts/lattice_points.h"
#include "client/files/format.h"
#include "client/files/write/atomic_file.h"
#include "core/base/vec3.h"

namespace affskel::client {

/// One sample point of a finished field.
struct FieldPoint {
  std::uint32_t i = 0, j = 0, k = 0;  ///< place in the lattice
  core::Vec3 position;                ///< mesh units
  double erosion = 0;                 ///< E, mesh units cubed
  core::Vec3 normal;                  ///< the optimal direction, unit
  std::uint32_t direction = 0;        ///< its index
};

/// Writes a field, point by point in lattice order.  Equal fields give equal bytes.
class FieldWriter {
 public:
  virtual ~FieldWriter() = default;
  virtual void put(const FieldPoint& point) = 0;
  /// Call once, last; the file is left uncommitted.
  virtual void finish() = 0;
};

/// Writer for one of field_formats().  `file` and `points` must outlive it.
std::unique_ptr<FieldWriter> make_field_writer(FileFormat format, AtomicFile& file,
                                               const LatticePoints& points);

/// The VTKHDF writer, see VtkHdfImage: PointData `E` (NaN outside), `normal` (0 outside), `direction` (-1
/// outside), `inside` (0 or 1).
std::unique_ptr<FieldWriter> make_vtkhdf_writer(AtomicFile& file, const LatticePoints& points);

/// Decodes a FIELD artefact as its bytes arrive, in pieces of any size.
class FieldDecoder {
 public:
  /// All arguments must outlive it.
  FieldDecoder(const LatticePoints& points, const v1::Directions& directions, FieldWriter& writer)
      : cursor_(points), directions_(directions), writer_(writer) {}

  void data(std::string_view bytes);
  /// Checks that every point got its record, and finishes the writer.
  /// @throws ClientError kInternal otherwise.
  void finish();

 private:
  void record(const char* bytes);

  LatticeCursor cursor_;
  const v1::Directions& directions_;
  FieldWriter& writer_;
  std::string rest_;  // the beginning of a record that was cut in two
};

}  // namespace affskel::client
