#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "client/base/lattice_points.h"

namespace affskel::client {

/// Cuts an artefact that holds one record per sample point, in lattice order, into its records as its bytes
/// arrive, in pieces of any size.
class RecordDecoder {
 public:
  /// Called with each record, which begins at `bytes`, and its point.
  using Take = std::function<void(const SamplePoint& at, const char* bytes)>;

  /// @param points must outlive it.  @param artifact, @param records name both in errors: "field", "records".
  RecordDecoder(const LatticePoints& points, std::size_t record_bytes, std::string artifact,
                std::string records, Take take);

  /// @throws ClientError kInternal when there are more records than points.
  void data(std::string_view bytes);
  /// @throws ClientError kInternal when there were fewer.
  void finish() const;

 private:
  void record(const char* bytes);

  LatticeCursor cursor_;
  std::size_t record_bytes_;
  std::string artifact_, records_;
  Take take_;
  std::string rest_;  // the beginning of a record that was cut in two
};

}  // namespace affskel::client
