#include "client/artifacts/field_decoder.h"

#include <cstring>
#include <string>

#include "client/base/error.h"
#include "wire/limits.h"

namespace affskel::client {

FieldDecoder::FieldDecoder(const LatticePoints& points, const v1::Directions& directions,
                           FieldReceiver& receiver)
    : directions_(directions),
      receiver_(receiver),
      records_(points, wire::kFieldRecordBytes, "field", "records",
               [this](const SamplePoint& at, const char* bytes) { record(at, bytes); }) {}

void FieldDecoder::record(const SamplePoint& at, const char* bytes) {
  // A record: double E, double area, uint32 direction.
  FieldPoint point{at, 0, {}, 0};
  std::memcpy(&point.erosion, bytes, sizeof point.erosion);
  std::memcpy(&point.direction, bytes + 2 * sizeof(double), sizeof point.direction);
  const std::uint64_t first = 3 * std::uint64_t{point.direction};
  if (first + 3 > static_cast<std::uint64_t>(directions_.xyz_size())) {
    throw ClientError(ExitCode::kInternal, "the field names direction " + std::to_string(point.direction) +
                                               " of " + std::to_string(directions_.xyz_size() / 3));
  }
  const int x = static_cast<int>(first);
  point.normal = {directions_.xyz(x), directions_.xyz(x + 1), directions_.xyz(x + 2)};
  receiver_.put(point);
}

void FieldDecoder::finish() {
  records_.finish();
  receiver_.finish();
}

}  // namespace affskel::client
