#include "database/checksum.h"

#include <sqlite3.h>
#include <xxhash.h>

#include <bit>

namespace affskel::server {
namespace {

void checksum_function(sqlite3_context* context, int, sqlite3_value** values) {
  // The bytes first: asking for them may convert the value.
  const auto* data = static_cast<const char*>(sqlite3_value_blob(values[2]));
  const auto size = static_cast<std::size_t>(sqlite3_value_bytes(values[2]));
  sqlite3_result_int64(context,
                       checksum(sqlite3_value_int64(values[0]), sqlite3_value_int64(values[1]),
                                data == nullptr ? std::string_view() : std::string_view(data, size)));
}

}  // namespace

std::int64_t checksum(std::int64_t owner, std::int64_t index, std::string_view bytes) {
  const std::int64_t place[2] = {owner, index};
  const XXH64_hash_t seed = XXH3_64bits(place, sizeof place);
  return std::bit_cast<std::int64_t>(XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed));
}

int register_checksum(sqlite3* db) {
  return sqlite3_create_function_v2(db, "checksum", 3, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY,
                                    nullptr, checksum_function, nullptr, nullptr, nullptr);
}

}  // namespace affskel::server
