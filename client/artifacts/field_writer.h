#pragma once

#include "client/artifacts/field_decoder.h"
#include "core/files/field_file.h"

namespace affskel::client {

/// Writes a field as its points arrive.
class FieldWriter : public FieldReceiver {
 public:
  /// @param volume v0, mesh units cubed.  @param file must outlive it.  @throws as core::FieldFile.
  FieldWriter(core::FileFormat format, base::AtomicFile& file, const LatticePoints& points, double volume,
              const core::FileFacts& facts)
      : field_(format, file, points.grid(), volume, facts) {}

  void put(const FieldPoint& point) override {
    field_.put({point.i, point.j, point.k}, {point.erosion, point.area, point.normal, point.direction});
  }
  /// The file is left uncommitted.
  void finish() override { field_.finish(); }

 private:
  core::FieldFile field_;
};

}  // namespace affskel::client
