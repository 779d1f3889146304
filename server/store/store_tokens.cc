#include "access/token.h"
#include "store/store_impl.h"

namespace affskel::server {

std::optional<TokenRow> Store::find_token(std::string_view token) {
  return read([&](Database& db) { return server::find_token(db, token); });
}

bool Store::has_tokens() {
  return read([](Database& db) { return server::has_tokens(db); });
}

bool Store::has_valid_token() {
  return read([this](Database& db) { return server::has_valid_token(db, clock_.wall_ms()); });
}

std::vector<std::int64_t> Store::invalid_tokens(const std::vector<std::int64_t>& ids, std::int64_t now_ms) {
  return read([&](Database& db) { return server::invalid_tokens(db, ids, now_ms); });
}

void Store::note_tokens_used(const std::map<std::int64_t, std::int64_t>& last_used_ms) {
  write([&](Tx& tx) {
    for (const auto& [id, when] : last_used_ms) {
      tx.db.run("UPDATE tokens SET last_used_ms = max(ifnull(last_used_ms, 0), ?2) WHERE id = ?1", id, when);
    }
    return true;
  });
}

}  // namespace affskel::server
