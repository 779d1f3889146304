#include "client/artifacts/field_decoder.h"

#include <string>

#include "client/base/error.h"
#include "wire/field_record.h"

namespace affskel::client {

FieldDecoder::FieldDecoder(const LatticePoints& points, const v1::Directions& directions,
                           FieldReceiver& receiver)
    : directions_(directions),
      receiver_(receiver),
      records_(points, wire::kFieldRecordBytes, "field", "records",
               [this](const SamplePoint& at, const char* bytes) { record(at, bytes); }) {}

void FieldDecoder::record(const SamplePoint& at, const char* bytes) {
  const wire::FieldRecord record = wire::decode_field_record(bytes);
  FieldPoint point{at, record.erosion, record.area, {}, record.direction};
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
