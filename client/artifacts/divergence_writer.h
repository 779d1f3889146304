#pragma once

#include <string_view>

#include "client/artifacts/record_decoder.h"
#include "client/files/write/lattice_table.h"

namespace affskel::client {

/// Writes a DIVERGENCE artefact as its bytes arrive, in pieces of any size, in one of divergence_formats():
/// the LatticeTable with the column `H` (NaN outside).
class DivergenceWriter {
 public:
  /// `file` and `points` must outlive it.
  DivergenceWriter(FileFormat format, base::AtomicFile& file, const LatticePoints& points);

  void data(std::string_view bytes) { values_.data(bytes); }
  /// Checks that every point got its value.  The file is left uncommitted.
  /// @throws ClientError kInternal otherwise.
  void finish();

 private:
  LatticeTable table_;
  RecordDecoder values_;
};

}  // namespace affskel::client
