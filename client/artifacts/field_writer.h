#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "client/artifacts/field_decoder.h"
#include "core/files/field_file.h"

namespace affskel::client {

/// Writes a field as its points arrive.
class FieldWriter : public FieldReceiver {
 public:
  /// @param volume v0, mesh units cubed.  @param parts per sample point, or none.  @param file must outlive it.
  /// @param all_directions whether the field is REFINED.
  /// @throws as core::FieldFile.
  FieldWriter(core::FileFormat format, base::AtomicFile& file, const LatticePoints& points, double volume,
              const core::FileFacts& facts, std::vector<std::uint32_t> parts = {},
              bool all_directions = false)
      : parts_(std::move(parts)),
        field_(format, file, points.grid(), volume, facts,
               {.parts = !parts_.empty(), .all_directions = all_directions}) {}

  void put(const FieldPoint& point) override {
    const std::uint32_t part = parts_.empty() ? 0 : parts_.at(rank_++);
    field_.put({point.i, point.j, point.k},
               {point.erosion, point.slope, point.normal, point.direction, part, point.saddles});
  }
  /// The file is left uncommitted.
  void finish() override { field_.finish(); }

 private:
  std::vector<std::uint32_t> parts_;
  std::size_t rank_ = 0;
  core::FieldFile field_;
};

}  // namespace affskel::client
