#pragma once

#include <cstdint>
#include <optional>

#include "core/erosion/outside_erosion.h"
#include "core/files/lattice_table.h"

namespace affskel::core {

/// What a field says of a sample point.
struct FieldSample {
  double erosion = 0;           ///< E, mesh units cubed
  double area = 0;              ///< of the section, mesh units squared: |grad E|
  Vec3 normal;                  ///< the optimal direction, unit
  std::uint32_t direction = 0;  ///< its index
  std::uint32_t part = 0;       ///< of the solid, from 1; only where the file has them
};

/// Writes a field in one of field_formats(): a LatticeTable with the columns `E`, `normal` (nx, ny, nz in
/// text) and `direction`, when asked for `part`, and in grids `E_share`, E / v0.  Outside, E is continued (see
/// OutsideErosion) by one place and 0 beyond, the normal 0, the direction -1, the part 0.  Equal fields give equal bytes.
class FieldFile {
 public:
  /// @param lattice mesh units.  @param volume v0, mesh units cubed.  @param file must outlive it.
  /// @throws as LatticeTable, also from the others.
  FieldFile(FileFormat format, base::AtomicFile& file, const LatticeGrid& lattice, double volume,
            const FileFacts& facts, bool parts = false);
  FieldFile(const FieldFile&) = delete;
  FieldFile& operator=(const FieldFile&) = delete;

  /// The next sample point, in lattice order.
  void put(const LatticePlace& at, const FieldSample& sample);
  /// Call once, last; the file is left uncommitted.
  void finish();

 private:
  LatticeTable table_;
  std::array<Vec3, 3> axes_;
  double volume_;
  bool parts_;
  std::optional<OutsideErosion> outside_;  // of grids
};

}  // namespace affskel::core
