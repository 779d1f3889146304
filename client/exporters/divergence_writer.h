#pragma once

#include <string>
#include <string_view>

#include "client/exporters/atomic_file.h"
#include "client/exporters/format.h"
#include "client/exporters/lattice_points.h"

namespace affskel::client {

/// Writes a DIVERGENCE artefact as its bytes arrive, in pieces of any size: H at every sample point in
/// lattice order, in one of divergence_formats(): .csv `x,y,z,H`, .dat the same, separated by blanks, no
/// header.
class DivergenceWriter {
 public:
  /// `file` and `points` must outlive it.
  DivergenceWriter(FileFormat format, AtomicFile& file, const LatticePoints& points);

  void data(std::string_view bytes);
  /// Checks that every point got its value.  @throws ClientError kInternal otherwise.
  void finish();

 private:
  void value(double divergence);

  AtomicFile& file_;
  LatticeCursor cursor_;
  char separator_;
  std::string rest_;  // the beginning of a value that was cut in two
  std::string row_;
};

}  // namespace affskel::client
