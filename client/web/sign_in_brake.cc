#include "client/web/sign_in_brake.h"

#include <algorithm>

#include "wire/sha256.h"

namespace affskel::client {
namespace {

// Makes room by the neighbour of the newest.  Where keys are hashes no caller can choose which that is.
template <typename Entries>
void trim(Entries& entries, typename Entries::iterator newest, std::size_t most) {
  if (entries.size() <= most) return;
  const auto after = std::next(newest);
  entries.erase(after == entries.end() ? entries.begin() : after);
}

SignInBrake::Clock::duration pause(unsigned wrong, unsigned free, std::chrono::milliseconds first,
                                   std::chrono::milliseconds longest) {
  if (wrong < free) return {};
  return std::min(longest, first * (1 << std::min(wrong - free, 10u)));
}

}  // namespace

std::string SignInBrake::hash(const std::string& token) const {
  return wire::sha256_hex(salt_ + token);
}

void SignInBrake::forget_old(Tries& tries, Clock::time_point now) const {
  const auto gone = static_cast<std::uint64_t>((now - tries.last) / limits_.forget);
  if (gone == 0) return;
  tries.wrong -= static_cast<unsigned>(std::min<std::uint64_t>(tries.wrong, gone));
  tries.last = now;
}

SignInBrake::Tries& SignInBrake::tries_of(const std::string& peer) {
  const auto entry = of_peer_.try_emplace(peer).first;
  trim(of_peer_, entry, limits_.addresses);
  return entry->second;
}

std::optional<SignInBrake::Clock::duration> SignInBrake::put_off(const std::string& peer,
                                                                 const std::string& token) {
  const std::string key = hash(token);
  const base::MutexLock lock(mutex_);
  const Clock::time_point now = now_();
  Tries& own = tries_of(peer);
  for (Tries* tries : {&own, &all_}) forget_old(*tries, now);
  const bool known = right_.count(key) > 0;
  if (!known && (own.wrong >= limits_.free || all_.wrong >= limits_.free_in_all)) {
    const auto [again, is_new] = again_.try_emplace(key, now + limits_.again);
    if (is_new) trim(again_, again, limits_.tokens);
    const Clock::time_point earliest = std::max({again->second, own.next, all_.next});
    if (now < earliest) return earliest - now;
  }
  own.next = now + pause(++own.wrong, limits_.free, limits_.first, limits_.longest);
  all_.next = now + pause(++all_.wrong, limits_.free_in_all, limits_.first, limits_.longest_in_all);
  own.last = all_.last = now;
  return std::nullopt;
}

// What was counted when it was looked at.
void SignInBrake::take_back(const std::string& peer) {
  for (Tries* tries : {&tries_of(peer), &all_}) {
    if (tries->wrong > 0) --tries->wrong;
  }
}

void SignInBrake::was_right(const std::string& peer, const std::string& token) {
  const base::MutexLock lock(mutex_);
  take_back(peer);
  trim(right_, right_.insert(hash(token)).first, limits_.tokens);
}

void SignInBrake::was_wrong(const std::string& token) {
  const std::string key = hash(token);
  const base::MutexLock lock(mutex_);
  right_.erase(key);
  trim(again_, again_.insert_or_assign(key, now_() + limits_.wrong).first, limits_.tokens);
}

void SignInBrake::was_not_seen(const std::string& peer) {
  const base::MutexLock lock(mutex_);
  take_back(peer);
}

}  // namespace affskel::client
