#include "traffic/frame_guard.h"

#include <algorithm>
#include <utility>

namespace affskel::server {
namespace {

// RFC 9113, section 6.
enum Type : std::uint8_t {
  kData = 0,
  kHeaders = 1,
  kPriority = 2,
  kReset = 3,
  kSettings = 4,
  kPing = 6,
  kGoAway = 7,
  kWindowUpdate = 8,
  kContinuation = 9,
};
constexpr std::uint8_t kEndStream = 1;  // of DATA and HEADERS
constexpr std::uint8_t kAck = 1;        // of SETTINGS and PING
constexpr std::uint8_t kEndHeaders = 4;

// Of a message: gRPC keeps about as many bytes beside those of a frame.
constexpr std::size_t kCrumbBytes = 128;

}  // namespace

/// Calls on_frame for each head that is complete; contents are passed over.
template <typename OnFrame>
void FrameGuard::read(Position& position, std::string_view bytes, OnFrame on_frame) {
  while (!bytes.empty()) {
    if (position.rest > 0) {
      const std::size_t part = std::min(position.rest, bytes.size());
      position.rest -= part;
      bytes.remove_prefix(part);
      continue;
    }
    const std::size_t part = std::min(kHeadBytes - position.got, bytes.size());
    std::copy_n(bytes.begin(), part, position.head.begin() + static_cast<std::ptrdiff_t>(position.got));
    position.got += part;
    bytes.remove_prefix(part);
    if (position.got < kHeadBytes) return;
    const auto& head = position.head;
    const auto number = [&head](std::size_t from, std::size_t to) {
      std::uint32_t value = 0;
      for (std::size_t i = from; i < to; ++i) value = value << 8 | head[i];
      return value;
    };
    position.got = 0;
    position.rest = number(0, 3);
    on_frame(Frame{position.rest, head[3], head[4], number(5, 9) & 0x7fffffffU});
  }
}

std::size_t FrameGuard::from_client(std::string_view bytes) {
  const std::size_t part = std::min(kPreface.size() - preface_, bytes.size());
  if (bytes.substr(0, part) != kPreface.substr(preface_, part)) throw FrameFault("it does not speak HTTP/2");
  preface_ += part;
  std::size_t cost = refused_;
  refused_ = 0;
  read(from_client_, bytes.substr(part), [&](const Frame& frame) { cost += on_client_frame(frame); });
  return cost;
}

std::size_t FrameGuard::on_client_frame(const Frame& frame) {
  const bool in_block = block_stream_ != 0;
  if (in_block && (frame.type != kContinuation || frame.stream != block_stream_))
    throw FrameFault("a frame within the headers of a call");
  switch (frame.type) {
    case kHeaders:
      block_bytes_ = block_frames_ = 0;
      return on_headers(frame);
    case kContinuation:
      if (!in_block) throw FrameFault("headers go on that have not begun");
      return on_headers(frame);
    case kReset: {
      const bool known = open_.contains(frame.stream);
      end(frame.stream);
      return known || frame.stream > last_stream_ ? 1 : 0;  // not of calls that have ended meanwhile
    }
    case kData:
      if ((frame.flags & kEndStream) != 0) return 0;
      if (frame.length < kCrumbBytes) on_crumb(frame.stream);
      return frame.length == 0 ? 1 : 0;
    case kSettings:
    case kPing:
      return (frame.flags & kAck) == 0 ? 1 : 0;
    case kWindowUpdate:
      return 0;
    default:
      return 1;
  }
}

/// A part of a header block.
std::size_t FrameGuard::on_headers(const Frame& frame) {
  block_bytes_ += frame.length;
  ++block_frames_;
  if (block_bytes_ > limits_.block_bytes || block_frames_ > limits_.block_frames) {
    throw FrameFault("the headers of a call are longer than " + std::to_string(limits_.block_bytes) +
                     " bytes or " + std::to_string(limits_.block_frames) + " frames");
  }
  block_stream_ = (frame.flags & kEndHeaders) != 0 ? 0 : frame.stream;
  const bool is_new = frame.stream > last_stream_;
  if (is_new) {
    last_stream_ = frame.stream;
    ++calls_;
    open_.try_emplace(frame.stream);
  }
  const auto call = open_.find(frame.stream);
  if (call == open_.end()) return 0;  // it has ended; gRPC passes over what comes late
  hold(call->second.headers);
  return is_new && open_.size() > limits_.calls ? 1 : 0;
}

void FrameGuard::on_crumb(std::uint32_t stream) {
  const auto call = open_.find(stream);
  if (call != open_.end()) hold(call->second.crumbs);
}

void FrameGuard::hold(std::size_t& frames) {
  ++frames;
  if (++held_frames_ > limits_.held_frames) {
    throw FrameFault("the calls under way are cut into more than " + std::to_string(limits_.held_frames) +
                     " frames");
  }
}

void FrameGuard::from_server(std::string_view bytes) {
  read(from_server_, bytes, [this](const Frame& frame) { on_server_frame(frame); });
}

void FrameGuard::on_server_frame(const Frame& frame) {
  if (frame.type == kData) answered_ += frame.length;
  const bool ends = (frame.type == kData || frame.type == kHeaders) && (frame.flags & kEndStream) != 0;
  if (frame.type == kReset && open_.contains(frame.stream)) ++refused_;
  if (frame.type == kWindowUpdate) release_crumbs(frame.stream);
  if (ends || frame.type == kReset) end(frame.stream);
}

void FrameGuard::release_crumbs(std::uint32_t stream) {
  const auto call = open_.find(stream);
  if (call != open_.end()) held_frames_ -= std::exchange(call->second.crumbs, 0);
}

void FrameGuard::end(std::uint32_t stream) {
  const auto call = open_.find(stream);
  if (call == open_.end()) return;
  held_frames_ -= call->second.headers + call->second.crumbs;
  open_.erase(call);
}

}  // namespace affskel::server
