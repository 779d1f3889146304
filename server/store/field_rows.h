#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "database/sqlite.h"

namespace affskel::server {

/// The stored rows of a field and their checksums (database/checksum.h).  Bytes that do not match theirs are
/// never used.  All functions that read throw StoreError kDamaged, which names erosion, row and remedy.

/// Whether a chunk's bytes are those that were stored.
bool chunk_is_sound(Database& db, std::int64_t erosion_id, std::int64_t index, std::string_view bytes);

/// Bytes of chunk `index`; empty when no report has touched it.
std::string load_chunk(Database& db, std::int64_t erosion_id, std::int64_t index);

void insert_chunk(Database& db, std::int64_t erosion_id, std::int64_t index, std::string_view bytes);

/// Records the checksum of a chunk that was rewritten.
void sign_chunk(Database& db, std::int64_t erosion_id, std::int64_t index, std::string_view bytes);

/// Adds logged records of a part of the field; any number of bytes that a row can hold.
void insert_log(Database& db, std::int64_t erosion_id, std::int64_t part, std::string_view bytes);

/// Calls `take` with the bytes of each row of the log that may have records of the part.
void load_log(Database& db, std::int64_t erosion_id, std::int64_t part,
              const std::function<void(std::string_view)>& take);

/// Whether a row of the log has the bytes that were stored.
bool log_is_sound(std::int64_t erosion_id, std::string_view bytes, std::int64_t sum);

std::int64_t logged_bytes(Database& db, std::int64_t erosion_id, std::int64_t part);

}  // namespace affskel::server
