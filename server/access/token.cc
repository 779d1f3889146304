#include "access/token.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "access/owner_name.h"
#include "base/quoted.h"
#include "base/random.h"
#include "database/errors.h"
#include "wire/sha256.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

constexpr std::size_t kTokenBytes = 32;

constexpr const char* kColumns =
    "SELECT id, owner, role, created_ms, expires_ms, revoked_ms, last_used_ms FROM tokens ";

std::string selection(std::string_view rest) {
  std::string sql = kColumns;
  sql += rest;
  return sql;
}

TokenRow read_row(const Statement& row) {
  Columns columns(row);
  TokenRow token;
  token.id = columns.integer();
  token.owner = columns.text();
  token.role = wire::value_of_word<v1::Role>(columns.text()).value_or(v1::ROLE_UNSPECIFIED);
  token.created_ms = columns.integer();
  token.expires_ms = columns.integer_or_null();
  token.revoked_ms = columns.integer_or_null();
  token.last_used_ms = columns.integer_or_null();
  return token;
}

/// RFC 4648, section 5, without padding.
std::string base64url(const unsigned char* bytes, std::size_t size) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  std::string text;
  std::uint32_t held = 0;
  int bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    held = (held << 8) | bytes[i];
    for (bits += 8; bits >= 6; bits -= 6) text.push_back(kDigits[(held >> (bits - 6)) & 63]);
  }
  if (bits > 0) text.push_back(kDigits[(held << (6 - bits)) & 63]);
  return text;
}

std::vector<std::string> owners_of_tokens(Database& db) {
  Statement row = db.query("SELECT DISTINCT owner FROM tokens");
  std::vector<std::string> owners;
  while (row.step()) owners.push_back(row.text(0));
  return owners;
}

void check_new_owner(Database& db, const std::string& owner) {
  const std::vector<std::string> owners = owners_of_tokens(db);
  if (std::find(owners.begin(), owners.end(), owner) != owners.end()) return;  // whatever was allowed then
  check_owner_name(owner);
  const std::string other = look_alike(owner, owners);
  if (other.empty()) return;
  throw StoreError(StoreError::Code::kInvalid, "the owner " + base::quoted(owner) + " looks like " +
                                                   base::quoted(other) + ", who has a token already");
}

}  // namespace

std::string new_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  base::fill_with_random(bytes);
  return "affskel_" + base64url(bytes.data(), bytes.size());
}

std::int64_t add_token(Database& db, const std::string& token, const std::string& owner, v1::Role role,
                       std::int64_t now_ms, std::optional<std::int64_t> expires_ms) {
  check_new_owner(db, owner);
  db.run("INSERT INTO tokens (sha256, owner, role, created_ms, expires_ms) VALUES (?, ?, ?, ?, ?)",
         wire::sha256_hex(token), owner, wire::word(role), now_ms, expires_ms);
  return db.last_insert_rowid();
}

std::vector<TokenRow> list_tokens(Database& db) {
  static const std::string sql = selection("ORDER BY id");
  Statement row = db.query(sql.c_str());
  std::vector<TokenRow> tokens;
  while (row.step()) tokens.push_back(read_row(row));
  return tokens;
}

std::optional<TokenRow> find_token(Database& db, std::string_view token) {
  static const std::string sql = selection("WHERE sha256 = ?");
  Statement row = db.query(sql.c_str(), wire::sha256_hex(token));
  if (!row.step()) return std::nullopt;
  return read_row(row);
}

bool has_tokens(Database& db) {
  return db.integer("SELECT 1 FROM tokens LIMIT 1").has_value();
}

bool has_valid_token(Database& db, std::int64_t now_ms) {
  return db
      .integer(
          "SELECT 1 FROM tokens WHERE revoked_ms IS NULL AND (expires_ms IS NULL OR expires_ms > ?) LIMIT 1",
          now_ms)
      .has_value();
}

void revoke_token(Database& db, std::int64_t id, std::int64_t now_ms) {
  if (db.run("UPDATE tokens SET revoked_ms = ifnull(revoked_ms, ?) WHERE id = ?", now_ms, id) == 0) {
    throw StoreError(StoreError::Code::kNotFound, "no token " + std::to_string(id));
  }
}

void remove_token(Database& db, std::int64_t id) {
  db.run("DELETE FROM tokens WHERE id = ?", id);
}

std::vector<std::int64_t> invalid_tokens(Database& db, const std::vector<std::int64_t>& ids,
                                         std::int64_t now_ms) {
  std::vector<std::int64_t> invalid;
  for (const std::int64_t id : ids) {
    const auto valid = db.integer(
        "SELECT 1 FROM tokens WHERE id = ? AND revoked_ms IS NULL AND (expires_ms IS NULL OR expires_ms > ?)",
        id, now_ms);
    if (!valid) invalid.push_back(id);
  }
  return invalid;
}

}  // namespace affskel::server
