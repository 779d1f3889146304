#include "client/artifacts/record_decoder.h"

#include <algorithm>
#include <utility>

#include "client/base/error.h"

namespace affskel::client {

RecordDecoder::RecordDecoder(const LatticePoints& points, std::size_t record_bytes, std::string artifact,
                             std::string records, Take take)
    : cursor_(points),
      record_bytes_(record_bytes),
      artifact_(std::move(artifact)),
      records_(std::move(records)),
      take_(std::move(take)) {}

void RecordDecoder::data(std::string_view bytes) {
  if (!rest_.empty()) {
    const std::size_t missing = std::min(record_bytes_ - rest_.size(), bytes.size());
    rest_.append(bytes.substr(0, missing));
    bytes.remove_prefix(missing);
    if (rest_.size() < record_bytes_) return;
    record(rest_.data());
    rest_.clear();
  }
  for (; bytes.size() >= record_bytes_; bytes.remove_prefix(record_bytes_)) record(bytes.data());
  rest_.assign(bytes);
}

void RecordDecoder::record(const char* bytes) {
  if (cursor_.at_end()) {
    throw ClientError(ExitCode::kInternal,
                      "the " + artifact_ + " has more " + records_ + " than sample points");
  }
  take_(cursor_.point(), bytes);
  cursor_.advance();
}

void RecordDecoder::finish() const {
  if (rest_.empty() && cursor_.at_end()) return;
  throw ClientError(ExitCode::kInternal,
                    "the " + artifact_ + " has fewer " + records_ + " than sample points");
}

}  // namespace affskel::client
