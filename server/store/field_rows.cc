#include "store/field_rows.h"

#include <optional>

#include "database/checksum.h"
#include "database/errors.h"

namespace affskel::server {
namespace {

// The log belongs to no chunk.
constexpr std::int64_t kLogIndex = -1;

StoreError damaged(std::int64_t erosion_id, const std::string& row) {
  return {StoreError::Code::kDamaged,
          "the stored field is damaged (erosion " + std::to_string(erosion_id) + ", " + row +
              " does not match its checksum); stop the server and run affskel-server check --repair, which"
              " has the lost directions computed again"};
}

std::string chunk_name(std::int64_t index) {
  return "chunk " + std::to_string(index);
}

}  // namespace

bool chunk_is_sound(Database& db, std::int64_t erosion_id, std::int64_t index, std::string_view bytes) {
  const std::optional<std::int64_t> sum =
      db.integer("SELECT sum FROM field_sums WHERE erosion_id = ? AND idx = ?", erosion_id, index);
  return sum && *sum == checksum(erosion_id, index, bytes);
}

std::string load_chunk(Database& db, std::int64_t erosion_id, std::int64_t index) {
  Statement row =
      db.query("SELECT data FROM field_chunks WHERE erosion_id = ? AND idx = ?", erosion_id, index);
  if (row.step()) {
    if (!chunk_is_sound(db, erosion_id, index, row.blob(0))) throw damaged(erosion_id, chunk_name(index));
    return std::string(row.blob(0));
  }
  if (db.integer("SELECT 1 FROM field_sums WHERE erosion_id = ? AND idx = ?", erosion_id, index)) {
    throw damaged(erosion_id, chunk_name(index) + " is missing and");
  }
  return {};
}

void insert_chunk(Database& db, std::int64_t erosion_id, std::int64_t index, std::string_view bytes) {
  if (db.integer("SELECT 1 FROM field_sums WHERE erosion_id = ? AND idx = ?", erosion_id, index)) {
    throw damaged(erosion_id, chunk_name(index) + " is missing and");
  }
  db.run("INSERT INTO field_chunks (erosion_id, idx, data) VALUES (?, ?, ?)", erosion_id, index, Blob{bytes});
  sign_chunk(db, erosion_id, index, bytes);
}

void sign_chunk(Database& db, std::int64_t erosion_id, std::int64_t index, std::string_view bytes) {
  db.run(
      "INSERT INTO field_sums (erosion_id, idx, sum) VALUES (?, ?, ?)"
      " ON CONFLICT (erosion_id, idx) DO UPDATE SET sum = excluded.sum",
      erosion_id, index, checksum(erosion_id, index, bytes));
}

void insert_log(Database& db, std::int64_t erosion_id, std::int64_t part, std::string_view bytes) {
  db.run("INSERT INTO field_log (erosion_id, part, bytes, data, sum) VALUES (?, ?, ?, ?, ?)", erosion_id,
         part, bytes.size(), Blob{bytes}, checksum(erosion_id, kLogIndex, bytes));
}

void load_log(Database& db, std::int64_t erosion_id, std::int64_t part,
              const std::function<void(std::string_view)>& take) {
  Statement row = db.query(
      "SELECT data, sum, id FROM field_log WHERE erosion_id = ?1 AND part = ?2 UNION ALL"
      " SELECT data, sum, id FROM field_log WHERE erosion_id = ?1 AND part IS NULL",
      erosion_id, part);
  while (row.step()) {
    if (!log_is_sound(erosion_id, row.blob(0), row.integer(1))) {
      throw damaged(erosion_id, "logged report " + row.text(2));
    }
    take(row.blob(0));
  }
}

bool log_is_sound(std::int64_t erosion_id, std::string_view bytes, std::int64_t sum) {
  return sum == checksum(erosion_id, kLogIndex, bytes);
}

std::int64_t logged_bytes(Database& db, std::int64_t erosion_id, std::int64_t part) {
  return db.integer("SELECT sum(bytes) FROM field_log WHERE erosion_id = ? AND part = ?", erosion_id, part)
      .value_or(0);
}

}  // namespace affskel::server
