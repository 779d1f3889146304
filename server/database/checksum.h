#pragma once

#include <cstdint>
#include <string_view>

struct sqlite3;

namespace affskel::server {

/// A fast checksum (XXH3, 64 bits) of bytes and of the place where they belong, so that bytes at a wrong
/// place are found, too.  It finds accidents, not forgeries.
std::int64_t checksum(std::int64_t owner, std::int64_t index, std::string_view bytes);

/// Makes it known to SQL as checksum(owner, index, blob).  Returns SQLite's code.
int register_checksum(sqlite3* db);

}  // namespace affskel::server
