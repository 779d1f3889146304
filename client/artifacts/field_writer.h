#pragma once

#include "client/artifacts/field_decoder.h"
#include "client/files/write/lattice_table.h"

namespace affskel::client {

/// Writes a field in one of field_formats(), as the LatticeTable with the columns `E` (NaN outside), `normal`
/// (0 outside; nx, ny, nz in text) and `direction` (-1 outside).  Equal fields give equal bytes.
class FieldWriter : public FieldReceiver {
 public:
  /// `file` and `points` must outlive it.
  FieldWriter(FileFormat format, base::AtomicFile& file, const LatticePoints& points);

  void put(const FieldPoint& point) override;
  /// The file is left uncommitted.
  void finish() override { table_.finish(); }

 private:
  LatticeTable table_;
};

}  // namespace affskel::client
