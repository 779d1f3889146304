#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "core/files/file_facts.h"
#include "core/files/file_format.h"
#include "core/files/grid_file.h"
#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {

/// A column of a table over sample points.
struct LatticeColumn {
  std::string name;
  std::vector<std::string> components;  ///< their names in text; one, or several per point
  GridType type = GridType::kFloat64;   ///< in grids; whole numbers are left out of .dat
  double outside = 0;                   ///< in grids, of places outside the solid
  bool in_text = true;                  ///< whether .csv and .dat have it, too
};

/// A table with named columns over the sample points of a lattice, which is written row by row in lattice
/// order and never held as a whole.  `.csv`: a header line x,y,z and the components, 17 significant digits.
/// `.dat`: the published program's layout, the same separated by blanks, without a header and without whole
/// numbers.  These two hold numbers alone.  The others are grids of all places of the lattice and one layer
/// more around it, with an array per column, `inside`, 0 or 1, and what the file is: `.vti` and `.vts`
/// (make_vtk_xml_grid), `.vtkhdf` and `.hdf` (make_vtkhdf_grid).
class LatticeTable {
 public:
  virtual ~LatticeTable() = default;
  /// @param values one per component, column by column.
  virtual void put(const LatticePlace& at, std::span<const double> values) = 0;
  /// The value of a component at a place outside, -1 to dims, of no effect in text.  Before a point of a
  /// layer more than two further is put.
  virtual void put_outside(const std::array<std::int64_t, 3>& /*at*/, std::size_t /*component*/,
                           double /*value*/) {}
  /// Call once, last; the file is left uncommitted.
  virtual void finish() {}
};

/// @param lattice mesh units.  @param file must outlive the table.
/// @throws CoreError kBadInput for .vti of a lattice whose axes are not those of the mesh; base::FileError,
///   CoreError kLimit and kInternal, also from the table.
std::unique_ptr<LatticeTable> make_lattice_table(FileFormat format, base::AtomicFile& file,
                                                 const LatticeGrid& lattice,
                                                 const std::vector<LatticeColumn>& columns,
                                                 const FileFacts& facts);

/// Whether a file of this format places the points of such a lattice.
/// @throws CoreError kBadInput, naming the format to take, when not.
void check_places(FileFormat format, const LatticeGrid& lattice);

}  // namespace affskel::core
