#include "services/sending.h"

#include <algorithm>
#include <utility>

namespace affskel::server {
namespace {

// A quarter of a stored piece, because many calls may each hold one.
constexpr std::size_t kMessageBytes = std::size_t{256} << 10;

}  // namespace

StreamCall::After Sending::send(CallLimit::Place place, std::unique_ptr<BlobReader> reader,
                                const v1::Job* job) {
  place_ = std::move(place);
  reader_ = std::move(reader);
  v1::ArtifactHeader& header = *message_.mutable_header();
  header.set_bytes(reader_->bytes());
  header.set_sha256(reader_->sha256());
  if (job != nullptr) *header.mutable_job() = *job;
  return After::kMove;
}

void Sending::OnWriteDone(bool ok) {
  place_.moved(message_.ByteSizeLong());
  moved(ok, [this] { return next(); });
}

StreamCall::After Sending::next() {
  on_taken();
  if (sent_ == piece_.size()) {
    piece_ = reader_->next();
    sent_ = 0;
  }
  if (piece_.empty()) return After::kEnd;
  const std::size_t bytes = std::min(kMessageBytes, piece_.size() - sent_);
  message_.set_data(piece_.data() + sent_, bytes);
  sent_ += bytes;
  return After::kMove;
}

void Sending::move() {
  place_.turn();
  StartWrite(&message_);
}

void Sending::ended() {
  reader_.reset();
  place_.leave();
  on_ended();
}

}  // namespace affskel::server
