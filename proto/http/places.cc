#include "http/places.h"

#include <algorithm>
#include <utility>

namespace affskel::http {
namespace {

namespace ip = boost::asio::ip;

// What an entry is when a place is needed, the first to go first.
enum Rank { kSilent, kIdle, kAnswered, kBusy, kWorking };

}  // namespace

std::string peer_key(const ip::address& address) {
  if (address.is_v4()) return address.to_string();
  const ip::address_v6 v6 = address.to_v6();
  if (v6.is_v4_mapped()) return ip::make_address_v4(ip::v4_mapped, v6).to_string();
  ip::address_v6::bytes_type bytes = v6.to_bytes();
  std::fill(bytes.begin() + 8, bytes.end(), std::uint8_t{0});
  return ip::address_v6(bytes).to_string() + "/64";
}

std::size_t Places::count(const Choice& choice) const {
  const auto counts = [&](const Entry& entry) { return !entry.closing && choice(entry); };
  return static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(), counts));
}

std::size_t Places::size() const {
  return count([](const Entry&) { return true; });
}

int Places::rank(const Entry& entry) const {
  if (entry.stage == Stage::kWork) return kWorking;
  if (entry.stage == Stage::kTransfer) return kBusy;
  // What was answered may close at any time, and its peer asks again by another (RFC 9112, section 9.3.1); to a
  // newcomer it would look like a service that is broken.
  if (now_() - entry.since <= limits_.grace) return entry.used ? kAnswered : kBusy;
  return entry.used ? kIdle : kSilent;
}

std::size_t Places::most_strangers() const {
  return limits_.connections - std::min(limits_.connections, limits_.for_known);
}

Places::Entry* Places::next_to_go(const Choice& choice) {
  Entry* found = nullptr;
  const auto order = [this](const Entry& entry) { return std::make_pair(rank(entry), entry.since); };
  for (Entry& entry : entries_) {
    if (entry.closing || !choice(entry)) continue;
    if (found == nullptr || order(entry) < order(*found)) found = &entry;
  }
  return found;
}

bool Places::close_one(const Choice& choice) {
  Entry* const found = next_to_go(choice);
  if (found == nullptr) return false;
  found->closing = true;
  found->close();
  return true;
}

Places::Clock::duration Places::pause() {
  if (count(is_stranger) < most_strangers() && size() < limits_.connections) return {};
  const Entry* const next = next_to_go(is_stranger);
  if (next == nullptr || rank(*next) < kBusy) return {};  // it was heard, or had the time for that
  return std::max(Clock::duration::zero(), next->came + limits_.stay - now_());
}

std::unique_ptr<Places::Place> Places::take(const std::string& peer, std::function<void()> close) {
  const Choice neighbour = [&](const Entry& entry) { return entry.owner.empty() && entry.peer == peer; };
  const Choice known_idle = [&](const Entry& entry) {
    return !entry.owner.empty() && rank(entry) < kAnswered;
  };
  const std::size_t neighbours = count(neighbour);
  const bool alone = neighbours == size();
  if (!alone && neighbours >= std::max<std::size_t>(1, limits_.connections / 2) && !close_one(neighbour))
    return nullptr;
  while (count(is_stranger) >= most_strangers()) {
    if (!close_one(is_stranger)) return nullptr;
  }
  if (size() >= limits_.connections && !close_one(is_stranger) && !close_one(known_idle)) return nullptr;
  const Clock::time_point now = now_();
  entries_.push_back({peer, std::move(close), now, now});
  return std::make_unique<Place>(*this, std::prev(entries_.end()));
}

void Places::Place::begin(Stage stage) {
  entry_->stage = stage;
  entry_->since = places_.now_();
}

bool Places::Place::belongs_to(const std::string& owner) {
  const auto idle_of_owner = [&](const Entry& entry) {
    return &entry != &*entry_ && entry.owner == owner && places_.rank(entry) < kAnswered;
  };
  const auto of_owner = [&](const Entry& entry) { return &entry != &*entry_ && entry.owner == owner; };
  if (!owner.empty() && places_.count(of_owner) >= places_.limits_.of_owner &&
      !places_.close_one(idle_of_owner))
    return false;
  entry_->owner = owner;
  return true;
}

void Places::Place::idles() {
  entry_->used = true;
  begin(Stage::kIdle);
}

void Places::Place::transfers() {
  begin(Stage::kTransfer);
}

void Places::Place::works() {
  begin(Stage::kWork);
}

}  // namespace affskel::http
