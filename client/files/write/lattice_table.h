#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "client/base/lattice_points.h"
#include "client/files/format.h"

namespace affskel::client {

/// A column of a table over sample points.
struct LatticeColumn {
  std::string name;
  std::vector<std::string> components;  ///< their names in text; one, or several per point
  bool whole = false;                   ///< an index: 32 bits in images, and not in .dat
  double outside = 0;                   ///< in images, of lattice points outside the solid
};

/// A table with named columns over the sample points of a lattice, which is written row by row in lattice
/// order and never held as a whole.  `.csv`: a header line x,y,z and the components, 17 significant digits.
/// `.dat`: the published program's layout, the same separated by blanks, without a header and without
/// indices.  `.vtkhdf`: an array per column and `inside`, 0 or 1 (see VtkHdfImage).
class LatticeTable {
 public:
  /// `file` and `points` must outlive it.  @throws ClientError, naming the file, also from the others.
  LatticeTable(FileFormat format, base::AtomicFile& file, const LatticePoints& points,
               const std::vector<LatticeColumn>& columns);
  ~LatticeTable();

  /// @param values one per component, column by column.
  void put(const SamplePoint& at, std::span<const double> values);
  /// Call once, last; the file is left uncommitted.
  void finish();

  /// What writes a format.
  class Output;

 private:
  std::unique_ptr<Output> output_;
};

}  // namespace affskel::client
