#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/erosion/outside_erosion.h"
#include "core/files/lattice_table.h"

namespace affskel::core {

/// What a field says of a sample point.
struct FieldSample {
  double erosion = 0;           ///< E, mesh units cubed
  double slope = 0;             ///< |grad E|, mesh units squared: the section's area, and more at saddles
  Vec3 normal;                  ///< the optimal direction, unit
  std::uint32_t direction = 0;  ///< its index; only of a field over a set
  std::uint32_t part = 0;       ///< of the solid, from 1; only where the file has them
  std::uint32_t saddles = 0;    ///< that the optimal plane touches; only of a field over all directions
};

/// Which columns a field has beside E and the normal.
struct FieldColumns {
  bool parts = false;           ///< `part`
  bool all_directions = false;  ///< `slope` and `saddles` instead of `direction`
};

/// Writes a field in one of field_formats(): a LatticeTable with the columns `E`, `normal` (nx, ny, nz in
/// text) and those of FieldColumns, and in grids `E_share`, E / v0.  Outside, E is continued (see
/// OutsideErosion) by one place and 0 beyond, the normal, slope and part are 0, direction and saddles -1.
/// Equal fields give equal bytes.
class FieldFile {
 public:
  /// @param lattice mesh units.  @param volume v0, mesh units cubed.  @param file must outlive it.
  /// @throws as make_lattice_table(), also from the others.
  FieldFile(FileFormat format, base::AtomicFile& file, const LatticeGrid& lattice, double volume,
            const FileFacts& facts, const FieldColumns& columns = {});
  FieldFile(const FieldFile&) = delete;
  FieldFile& operator=(const FieldFile&) = delete;

  /// The next sample point, in lattice order.
  void put(const LatticePlace& at, const FieldSample& sample);
  /// Call once, last; the file is left uncommitted.
  void finish();

 private:
  std::unique_ptr<LatticeTable> table_;
  std::array<Vec3, 3> axes_;
  double volume_;
  FieldColumns columns_;
  std::optional<OutsideErosion> outside_;  // of grids
};

}  // namespace affskel::core
