#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace affskel::core {

/// How many bytes may come out of so many packed ones: meshes shrink to a tenth, files made to fill a memory to a
/// thousandth.
std::uint64_t max_unpacked(std::size_t packed);

/// By what the bytes are compressed, told by the first of them: "gzip" (RFC 1952), "zstd" (RFC 8878), or nothing.
std::string_view compression_of(std::string_view bytes);

/// A file's name without the ending of a compression: "body.off" of "body.off.gz" and "body.off.zst".
std::string_view unpacked_name(std::string_view name);

/// The bytes that were compressed by gzip, zlib or zstd, of all members and frames.  Takes at most 40 MiB beside them.
/// @throws CoreError kBadInput for bytes that are damaged or cut off, and for zstd with a window of more than 32 MiB; kLimit
///   for more than max_unpacked().
std::string unpack(std::string_view bytes);

}  // namespace affskel::core
