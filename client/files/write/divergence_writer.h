#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "client/artifacts/lattice_points.h"
#include "client/files/format.h"
#include "client/files/write/atomic_file.h"

namespace affskel::client {

/// Where the values of a divergence go, one by one in lattice order.
class DivergenceOutput {
 public:
  virtual ~DivergenceOutput() = default;
  /// @param at the sample point.
  virtual void put(const LatticeCursor& at, double divergence) = 0;
  /// Call once, last; the file is left uncommitted.
  virtual void finish() = 0;
};

/// Writes a DIVERGENCE artefact as its bytes arrive, in pieces of any size: H at every sample point in
/// lattice order, in one of divergence_formats(): .csv `x,y,z,H`, .dat the same, separated by blanks, no
/// header, .vtkhdf the field's image with the arrays `H` (NaN outside) and `inside`.
class DivergenceWriter {
 public:
  /// `file` and `points` must outlive it.
  DivergenceWriter(FileFormat format, AtomicFile& file, const LatticePoints& points);

  void data(std::string_view bytes);
  /// Checks that every point got its value.  @throws ClientError kInternal otherwise.
  void finish();

 private:
  void value(double divergence);

  LatticeCursor cursor_;
  std::unique_ptr<DivergenceOutput> output_;
  std::string rest_;  // the beginning of a value that was cut in two
};

}  // namespace affskel::client
