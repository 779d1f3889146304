#include "client/artifacts/field_decoder.h"

#include <algorithm>
#include <string>

#include "client/base/error.h"
#include "wire/field_record.h"
#include "wire/refined_record.h"

namespace affskel::client {

FieldDecoder::FieldDecoder(const LatticePoints& points, const v1::Directions* directions,
                           FieldReceiver& receiver)
    : directions_(directions),
      receiver_(receiver),
      records_(points, directions == nullptr ? wire::kRefinedRecordBytes : wire::kFieldRecordBytes, "field",
               "records", [this](const SamplePoint& at, const char* bytes) {
                 directions_ == nullptr ? refined(at, bytes) : record(at, bytes);
               }) {}

void FieldDecoder::refined(const SamplePoint& at, const char* bytes) {
  const wire::RefinedRecord record = wire::decode_refined_record(bytes);
  const auto saddles = std::count_if(record.saddles.begin(), record.saddles.end(),
                                     [](std::uint32_t saddle) { return saddle != wire::kNoSaddle; });
  receiver_.put({at,
                 record.erosion,
                 record.slope,
                 {record.normal[0], record.normal[1], record.normal[2]},
                 0,
                 static_cast<std::uint32_t>(saddles)});
}

void FieldDecoder::record(const SamplePoint& at, const char* bytes) {
  const wire::FieldRecord record = wire::decode_field_record(bytes);
  FieldPoint point{at, record.erosion, record.area, {}, record.direction, 0};
  const std::uint64_t first = 3 * std::uint64_t{point.direction};
  if (first + 3 > static_cast<std::uint64_t>(directions_->xyz_size())) {
    throw ClientError(ExitCode::kInternal, "the field names direction " + std::to_string(point.direction) +
                                               " of " + std::to_string(directions_->xyz_size() / 3));
  }
  const int x = static_cast<int>(first);
  point.normal = {directions_->xyz(x), directions_->xyz(x + 1), directions_->xyz(x + 2)};
  receiver_.put(point);
}

void FieldDecoder::finish() {
  records_.finish();
  receiver_.finish();
}

}  // namespace affskel::client
