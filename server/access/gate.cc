#include "access/gate.h"

#include <pwd.h>
#include <unistd.h>
#include <algorithm>

#include <array>
#include <utility>

namespace affskel::server {
namespace {

// A token in use is written down this often.
constexpr std::int64_t kNoteMs = 60'000;

// A call may wait so long for a thread before it can be ended.
constexpr std::int64_t kTellMs = 60'000;

constexpr std::string_view kScheme = "bearer ";

/// The token of an authorization; another scheme is a token without an owner.  RFC 9110: the scheme's name
/// may be written in small or large letters.
std::string_view token_of(std::string_view authorization) {
  const std::string_view scheme = authorization.substr(0, kScheme.size());
  const bool bearer = std::equal(
      scheme.begin(), scheme.end(), kScheme.begin(), kScheme.end(),
      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
  return bearer ? authorization.substr(kScheme.size()) : std::string_view();
}

bool is_own_or_root(uid_t uid) {
  return uid == 0 || uid == geteuid();
}

}  // namespace

std::string user_name(uid_t uid) {
  std::array<char, 4096> buffer{};
  passwd entry{};
  passwd* found = nullptr;
  if (getpwuid_r(uid, &entry, buffer.data(), buffer.size(), &found) == 0 && found != nullptr) {
    return found->pw_name;
  }
  return "uid:" + std::to_string(uid);
}

Gate::Gate(TokenSource& tokens, GateOptions options) : tokens_(tokens), options_(std::move(options)) {}

Admission Gate::admit(Method method, const Credentials& credentials) {
  Attempt attempt;
  attempt.method = &rule_of(method);
  attempt.now_ms = options_.now_ms();
  attempt.needs_certificate = options_.client_certificates && !credentials.uid;
  attempt.has_certificate = credentials.has_certificate;
  attempt.several_tokens = credentials.several_authorizations;
  attempt.has_token = credentials.authorization.has_value();
  attempt.needs_token = !attempt.has_token && !credentials.uid && tokens_.has_tokens();
  if (attempt.has_token) attempt.token = tokens_.find_token(token_of(*credentials.authorization));
  Identity identity;
  if (attempt.token) {
    identity = {attempt.token->owner, attempt.token->role, attempt.token->id};
  } else if (credentials.uid) {
    identity = {user_name(*credentials.uid),
                is_own_or_root(*credentials.uid) ? v1::ROLE_ADMIN : v1::ROLE_USER, 0};
  } else if (!attempt.has_token && !attempt.needs_token) {
    identity = {"", v1::ROLE_ADMIN, 0};
  }
  attempt.role = identity.role;
  if (const grpc::Status status = decide(attempt); !status.ok()) return {status, {}};
  if (identity.token != 0) {
    const base::MutexLock lock(mutex_);
    used_ms_[identity.token] = attempt.now_ms;
    active_[identity.token] = attempt.now_ms;
  }
  return {grpc::Status::OK, identity};
}

std::vector<std::int64_t> Gate::newly_invalid() {
  std::vector<std::int64_t> ids;
  {
    const base::MutexLock lock(mutex_);
    for (const auto& [id, when] : active_) ids.push_back(id);
  }
  if (ids.empty()) return {};
  const std::int64_t now = options_.now_ms();
  const std::vector<std::int64_t> invalid = tokens_.invalid_tokens(ids, now);
  const base::MutexLock lock(mutex_);
  for (const std::int64_t id : invalid) {
    const auto known = active_.find(id);
    if (known != active_.end() && now - known->second > kTellMs) active_.erase(known);
  }
  return invalid;
}

void Gate::note_use() {
  std::map<std::int64_t, std::int64_t> used;
  {
    const base::MutexLock lock(mutex_);
    const std::int64_t now = options_.now_ms();
    if (used_ms_.empty() || (noted_ms_ != 0 && now - noted_ms_ < kNoteMs && now >= noted_ms_)) return;
    noted_ms_ = now;
    used.swap(used_ms_);
  }
  tokens_.note_tokens_used(used);
}

}  // namespace affskel::server
