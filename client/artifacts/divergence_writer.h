#pragma once

#include <memory>
#include <string_view>

#include "client/artifacts/record_decoder.h"
#include "core/files/lattice_table.h"

namespace affskel::client {

/// Writes a DIVERGENCE artefact as its bytes arrive, in pieces of any size, in one of divergence_formats(): a
/// core::LatticeTable with the column `H` (0 outside).
class DivergenceWriter {
 public:
  /// `file` and `points` must outlive it.  @throws as core::make_lattice_table(), also from the others.
  DivergenceWriter(core::FileFormat format, base::AtomicFile& file, const LatticePoints& points,
                   const core::FileFacts& facts);

  void data(std::string_view bytes) { values_.data(bytes); }
  /// Checks that every point got its value.  The file is left uncommitted.
  /// @throws ClientError kInternal otherwise.
  void finish();

 private:
  std::unique_ptr<core::LatticeTable> table_;
  RecordDecoder values_;
};

}  // namespace affskel::client
