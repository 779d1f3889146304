#include "client/web/web_sessions.h"

#include <algorithm>

#include "client/web/random_key.h"
#include "wire/sha256.h"

namespace affskel::client {

void WebSessions::drop_old() {
  const Clock::time_point now = now_();
  std::erase_if(sessions_, [&](const auto& entry) {
    return now - entry.second.used > limits_.idle || now - entry.second.begun > limits_.longest;
  });
}

void WebSessions::make_room(const std::string& owner) {
  const auto is_theirs = [&](const auto& entry) { return entry.second.user.owner == owner; };
  const auto count = std::count_if(sessions_.begin(), sessions_.end(), is_theirs);
  if (static_cast<std::size_t>(count) < limits_.of_owner) return;
  auto unused = sessions_.end();
  for (auto entry = sessions_.begin(); entry != sessions_.end(); ++entry) {
    if (is_theirs(*entry) && (unused == sessions_.end() || entry->second.used < unused->second.used))
      unused = entry;
  }
  sessions_.erase(unused);
}

std::optional<std::string> WebSessions::begin(const WebUser& user) {
  const base::MutexLock lock(mutex_);
  drop_old();
  make_room(user.owner);
  if (sessions_.size() >= limits_.sessions) return std::nullopt;
  std::string secret = random_key();
  sessions_[wire::sha256_hex(secret)] = {user, now_(), now_()};
  return secret;
}

std::optional<WebSessions::Found> WebSessions::find(const std::string& secret) {
  const base::MutexLock lock(mutex_);
  drop_old();
  const auto found = sessions_.find(wire::sha256_hex(secret));
  if (found == sessions_.end()) return std::nullopt;
  found->second.used = now_();
  return Found{found->first, found->second.user};
}

void WebSessions::end(const std::string& id) {
  const base::MutexLock lock(mutex_);
  sessions_.erase(id);
}

std::string WebSessions::new_key() {
  std::string key = random_key();
  const base::MutexLock lock(mutex_);
  keys_.insert(wire::sha256_hex(key));
  return key;
}

bool WebSessions::use_key(const std::string& key) {
  const base::MutexLock lock(mutex_);
  return keys_.erase(wire::sha256_hex(key)) > 0;
}

void WebSessions::give_back(const std::string& key) {
  const base::MutexLock lock(mutex_);
  keys_.insert(wire::sha256_hex(key));
}

}  // namespace affskel::client
