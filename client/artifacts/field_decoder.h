#pragma once

#include <cstdint>
#include <string_view>

#include "affskel/v1/types.pb.h"
#include "client/artifacts/record_decoder.h"
#include "client/base/lattice_points.h"
#include "core/base/vec3.h"

namespace affskel::client {

/// One sample point of a finished field.
struct FieldPoint : SamplePoint {
  double erosion = 0;           ///< E, mesh units cubed
  double slope = 0;             ///< |grad E|, mesh units squared: the section's area, and more at saddles
  core::Vec3 normal;            ///< the optimal direction, unit
  std::uint32_t direction = 0;  ///< its index; only of a field over a set
  std::uint32_t saddles = 0;    ///< that the optimal plane touches; only of a field over all directions
};

/// Takes a field, point by point in lattice order.
class FieldReceiver {
 public:
  virtual ~FieldReceiver() = default;
  virtual void put(const FieldPoint& point) = 0;
  /// Called once, last.
  virtual void finish() = 0;
};

/// Decodes a FIELD or REFINED artefact as its bytes arrive, in pieces of any size.
class FieldDecoder {
 public:
  /// All arguments must outlive it.
  /// @param directions of FIELD; null: REFINED.
  FieldDecoder(const LatticePoints& points, const v1::Directions* directions, FieldReceiver& receiver);

  void data(std::string_view bytes) { records_.data(bytes); }
  /// Checks that every point got its record, and finishes the receiver.
  /// @throws ClientError kInternal otherwise.
  void finish();

 private:
  void record(const SamplePoint& at, const char* bytes);
  void refined(const SamplePoint& at, const char* bytes);

  const v1::Directions* directions_;
  FieldReceiver& receiver_;
  RecordDecoder records_;
};

}  // namespace affskel::client
