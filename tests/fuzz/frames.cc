// Frames of HTTP/2 in both directions, whole and in pieces, in any order: the relay counts, and does no more.
#include "bytes.h"
#include "targets.h"
#include "tools/http2_frames.h"
#include "traffic/frame_guard.h"

namespace affskel::fuzz {
namespace {

void run(std::string_view input) {
  Bytes bytes(input);
  server::FrameLimits limits;
  limits.calls = 1 + bytes.below(16);
  limits.held_frames = 64;
  server::FrameGuard guard(limits);
  try {
    if (bytes.below(8) != 0) guard.from_client("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n");
    while (!bytes.empty()) {
      const bool from_client = bytes.below(4) != 0;
      const std::string_view piece = bytes.take(1 + bytes.byte());
      if (from_client) {
        guard.from_client(piece);
      } else {
        guard.from_server(piece);
      }
      if (guard.open_calls() > guard.calls()) throw Finding("more calls are open than were begun");
    }
  } catch (const server::FrameFault&) {
  }
}

std::vector<std::string> seeds() {
  using namespace tests::http2;
  std::string whole;
  const auto add = [&](bool from_client, const std::string& bytes) {
    whole += std::string{from_client ? '\1' : '\0', static_cast<char>(bytes.size() - 1)} + bytes;
  };
  const std::string headers(20, 'h');
  add(true, frame(kSettings, 0, 0));
  add(false, frame(kSettings, 0, 0) + frame(kSettings, kAck, 0));
  add(true, frame(kHeaders, 0, 1, headers) + frame(kContinuation, kEndHeaders, 1, headers));
  add(true, frame(kData, 0, 1, "\0\0\0\0\5hello") + frame(kData, kEndStream, 1));
  add(false, frame(kHeaders, kEndHeaders, 1, headers) + frame(kData, 0, 1, "12345"));
  add(false, frame(kHeaders, kEndHeaders | kEndStream, 1, headers));
  add(true, frame(kHeaders, kEndHeaders, 3, headers) + frame(kReset, 0, 3, std::string(4, '\0')));
  add(true, frame(kPing, 0, 0, "12345678") + frame(kWindowUpdate, 0, 0, std::string("\0\0\1\0", 4)));
  add(true, frame(kPriority, 0, 5, "12345") + frame(99, 0, 5));
  return {std::string{'\7', '\1'} + whole};
}

}  // namespace

const Target kFrames = {"frames", seeds, run, 20000};

}  // namespace affskel::fuzz
