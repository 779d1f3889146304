#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "affskel/v1/client_service.pb.h"
#include "database/sqlite.h"

namespace affskel::server {

/// What a server keeps of a token.  The token itself is told once, to the administrator that had it made.
struct TokenRow {
  std::int64_t id = 0;
  std::string owner;
  v1::Role role = v1::ROLE_UNSPECIFIED;
  std::int64_t created_ms = 0;               ///< this and the following: Unix time in milliseconds
  std::optional<std::int64_t> expires_ms;    ///< absent = never
  std::optional<std::int64_t> revoked_ms;    ///< absent = it was not
  std::optional<std::int64_t> last_used_ms;  ///< to about a minute; absent = never

  bool is_expired(std::int64_t now_ms) const { return expires_ms && *expires_ms <= now_ms; }
  bool is_valid(std::int64_t now_ms) const { return !revoked_ms && !is_expired(now_ms); }
};

/// A new token: "affskel_" and 256 random bits in base64url, 43 characters.
/// @throws std::runtime_error when the system has no random numbers.
std::string new_token();

/// Enters a token; only its SHA-256 is stored.  A token has 256 random bits, so that neither salt nor a slow
/// hash would make it harder to guess.
/// @param owner a good name (check_owner_name) that looks like no other owner's.  @param role
/// USER, WORKER or ADMIN.
/// @throws StoreError kInvalid for another owner or role.
/// @return its id.
std::int64_t add_token(Database& db, const std::string& token, const std::string& owner, v1::Role role,
                       std::int64_t now_ms, std::optional<std::int64_t> expires_ms);

/// Every token, in the order in which they were made, with revoked and expired ones.
std::vector<TokenRow> list_tokens(Database& db);

/// The row of a token, in whatever state.
std::optional<TokenRow> find_token(Database& db, std::string_view token);

/// Whether a token was ever added: from then on TCP callers have to show one.
bool has_tokens(Database& db);

/// Whether there is one that a caller could show.
bool has_valid_token(Database& db, std::int64_t now_ms);

/// Makes a token worthless; one that is so already stays as it is.  @throws StoreError kNotFound.
void revoke_token(Database& db, std::int64_t id, std::int64_t now_ms);

/// Takes back a token that was told to nobody.
void remove_token(Database& db, std::int64_t id);

/// Of these ids, those whose tokens are revoked or expired.
std::vector<std::int64_t> invalid_tokens(Database& db, const std::vector<std::int64_t>& ids,
                                         std::int64_t now_ms);

}  // namespace affskel::server
