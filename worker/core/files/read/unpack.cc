#include "core/files/read/unpack.h"

#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace affskel::core {
namespace {

constexpr std::size_t kUnpackedAtOnce = std::size_t{1} << 18;  // bytes that are unpacked at once
constexpr int kMaxZstdWindow = 25;                             // binary logarithm of bytes
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 31;
constexpr std::uint64_t kMaxGrowth = 100;  // times the packed bytes, above the first MiB

[[noreturn]] void damaged(const char* how, const std::string& why) {
  refuse(std::string("compressed by ") + how + ", and damaged: " + why);
}

// What has come out.
class Unpacked {
 public:
  explicit Unpacked(std::uint64_t most) : most_(most) {}

  void add(const std::vector<char>& piece, std::size_t size) {
    if (size > most_ - bytes_.size())
      throw CoreError(CoreError::Code::kLimit,
                      "unpacks to more than " + std::to_string(most_) + " bytes, which is no mesh's growth");
    bytes_.append(piece.data(), size);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::uint64_t most_;
  std::string bytes_;
};

void inflate_members(std::string_view bytes, Unpacked& out) {
  constexpr int kEither = 15 + 32;  // the largest window, and a header of gzip or zlib
  std::vector<char> piece(kUnpackedAtOnce);
  z_stream stream{};
  if (inflateInit2(&stream, kEither) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> ended(&stream, inflateEnd);
  bool ended_member = false;
  while (!bytes.empty()) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in =
        static_cast<uInt>(std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max()));
    const uInt given = stream.avail_in;
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    const int result = inflate(&stream, Z_NO_FLUSH);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result != Z_OK && result != Z_STREAM_END)
      damaged("gzip", stream.msg != nullptr ? stream.msg : "it is cut off");
    out.add(piece, piece.size() - stream.avail_out);
    bytes.remove_prefix(given - stream.avail_in);
    ended_member = result == Z_STREAM_END;
    if (ended_member) {
      // Tapes and some tools fill up with zeros behind the last member.
      bytes.remove_prefix(std::min(bytes.find_first_not_of('\0'), bytes.size()));
      inflateReset(&stream);
    }
  }
  if (!ended_member) damaged("gzip", "it is cut off");
}

void decompress_frames(std::string_view bytes, Unpacked& out) {
  std::vector<char> piece(kUnpackedAtOnce);
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (context == nullptr) throw std::bad_alloc();
  ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kMaxZstdWindow);
  ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
  std::size_t wanted = 0;  // 0 at the end of a frame
  bool full = false;
  while (in.pos < in.size || full) {
    ZSTD_outBuffer made{piece.data(), piece.size(), 0};
    wanted = ZSTD_decompressStream(context.get(), &made, &in);
    if (ZSTD_getErrorCode(wanted) == ZSTD_error_frameParameter_windowTooLarge)
      refuse("compressed by zstd with a window of more than " + std::to_string((1 << kMaxZstdWindow) >> 20) +
             " MiB, which is not read; compress it without --long");
    if (ZSTD_isError(wanted) != 0) damaged("zstd", ZSTD_getErrorName(wanted));
    out.add(piece, made.pos);
    full = made.pos == made.size && wanted != 0;
  }
  if (wanted != 0) damaged("zstd", "it is cut off");
}

}  // namespace

std::uint64_t max_unpacked(std::size_t packed) {
  return std::min(kMaxBytes, (std::uint64_t{1} << 20) + kMaxGrowth * packed);
}

std::string_view compression_of(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return "gzip";
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return "zstd";
  return "";
}

std::string_view unpacked_name(std::string_view name) {
  for (const std::string_view ending : {".gz", ".zst", ".GZ", ".ZST"})
    if (name.ends_with(ending)) return name.substr(0, name.size() - ending.size());
  return name;
}

std::string unpack(std::string_view bytes) {
  Unpacked out(max_unpacked(bytes.size()));
  if (compression_of(bytes) == "zstd")
    decompress_frames(bytes, out);
  else
    inflate_members(bytes, out);
  return out.take();
}

}  // namespace affskel::core
