#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

namespace affskel::server {

/// A client has sent what no client that means well sends; what() says what.
class FrameFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct FrameLimits {
  std::size_t block_bytes = 32768;  ///< of one header block, as sent; gRPC refuses 8 KiB of metadata
  std::size_t block_frames = 8;     ///< that one header block is cut into
  std::size_t calls = 1024;         ///< under way at once, as gRPC offers; what is beyond makes work
  std::size_t held_frames = 4096;   ///< see FrameGuard::held_frames
};

/// Reads the frames of one HTTP/2 connection (RFC 9113, section 4) as they pass, and says what they cost the
/// server.  gRPC 1.51 bounds what it keeps of header blocks frame by frame only (CVE-2023-33953), and neither
/// calls that are reset at once (CVE-2023-44487) nor its answers to pings and settings (CVE-2019-9512,
/// -9515), nor the pieces that messages are cut into.  Header blocks are not decoded: their size and number says
/// enough.  Not thread-safe.
class FrameGuard {
 public:
  explicit FrameGuard(const FrameLimits& limits = {}) : limits_(limits) {}

  /// Bytes from the client, in order, cut anywhere.
  /// @return how many of the frames that begin in them make the server work without waiting for the peer:
  ///   calls that are reset, by the client or because of what it sent, calls beyond the limit, pings,
  ///   settings, and frames without purpose.
  /// @throws FrameFault.
  std::size_t from_client(std::string_view bytes);

  /// Bytes to the client, in order, cut anywhere.
  void from_server(std::string_view bytes);

  /// Frames of the calls under way for which gRPC keeps a buffer or an entry each: those of headers, and those of
  /// messages that are shorter than such an entry is worth, until the server gives their call more window: it has
  /// read them then.
  std::size_t held_frames() const { return held_frames_; }
  /// Calls that are under way.
  std::size_t open_calls() const { return open_.size(); }
  /// Calls begun so far.
  std::uint64_t calls() const { return calls_; }
  /// Bytes of messages that went to the client.
  std::uint64_t answered() const { return answered_; }
  /// Whether the client has begun as HTTP/2 clients do.
  bool begun() const { return preface_ == kPreface.size(); }

 private:
  static constexpr std::string_view kPreface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
  static constexpr std::size_t kHeadBytes = 9;

  struct Frame {
    std::size_t length;
    std::uint8_t type;
    std::uint8_t flags;
    std::uint32_t stream;
  };
  /// What gRPC holds of a call.
  struct Held {
    std::size_t headers = 0;
    std::size_t crumbs = 0;
  };
  /// Where a direction is: in a frame's head, or in what follows it.
  struct Position {
    std::array<unsigned char, kHeadBytes> head{};
    std::size_t got = 0;   // of the head
    std::size_t rest = 0;  // of the frame's contents
  };

  template <typename OnFrame>
  static void read(Position& position, std::string_view bytes, OnFrame on_frame);
  std::size_t on_client_frame(const Frame& frame);
  void on_server_frame(const Frame& frame);
  std::size_t on_headers(const Frame& frame);
  void on_crumb(std::uint32_t stream);
  void hold(std::size_t& frames);
  void release_crumbs(std::uint32_t stream);
  void end(std::uint32_t stream);

  const FrameLimits limits_;
  std::size_t preface_ = 0;  // bytes of it so far
  Position from_client_, from_server_;
  std::uint32_t block_stream_ = 0;  // whose header block is unfinished; 0 = none
  std::size_t block_bytes_ = 0;
  std::size_t block_frames_ = 0;
  std::uint32_t last_stream_ = 0;
  std::unordered_map<std::uint32_t, Held> open_;  // by stream
  std::size_t held_frames_ = 0;
  std::size_t refused_ = 0;  // calls that the server has reset since the client last sent something
  std::uint64_t calls_ = 0;
  std::uint64_t answered_ = 0;
};

}  // namespace affskel::server
