#include "traffic/connections.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string_view>
#include <utility>

#include "base/mutex.h"
#include "traffic/call_ended.h"

namespace affskel::server {
namespace {

// Of an IPv6 address, what names a network; the rest is its hosts' to choose.
constexpr int kPrefixBytes = 8;

/// -1 for a peer that is not named by its descriptor.
int descriptor_of(std::string_view peer) {
  constexpr std::string_view kPrefix = "fd:";
  int fd = -1;
  if (peer.starts_with(kPrefix)) std::from_chars(peer.data() + kPrefix.size(), peer.data() + peer.size(), fd);
  return fd;
}

/// Connections that are not in the table have numbers of their own, beyond those of the table.
std::uint64_t number_of_stranger(const std::string& peer) {
  return std::hash<std::string>{}(peer) | (std::uint64_t{1} << 63);
}

}  // namespace

std::string peer_name(const sockaddr& address) {
  char text[INET6_ADDRSTRLEN] = "unknown";
  if (address.sa_family == AF_INET) {
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in&>(address).sin_addr, text, sizeof text);
  }
  if (address.sa_family != AF_INET6) return std::string("ip:") + text;
  in6_addr prefix = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
  const bool is_loopback = IN6_IS_ADDR_LOOPBACK(&prefix);
  if (!is_loopback) std::fill(std::begin(prefix.s6_addr) + kPrefixBytes, std::end(prefix.s6_addr), 0);
  inet_ntop(AF_INET6, &prefix, text, sizeof text);
  return std::string("ip:") + text + (is_loopback ? "" : "/64");
}

PeerIdentity peer_of(int fd) {
  sockaddr_storage name{};
  socklen_t size = sizeof name;
  if (getpeername(fd, reinterpret_cast<sockaddr*>(&name), &size) != 0) return {"gone"};
  if (name.ss_family != AF_UNIX) return {peer_name(reinterpret_cast<const sockaddr&>(name))};
  ucred credentials{};
  socklen_t length = sizeof credentials;
  if (getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &credentials, &length) != 0) return {"uid:unknown"};
  return {"uid:" + std::to_string(credentials.uid), credentials.uid};
}

Connections::Call::Call(Call&& other) noexcept
    : table_(std::exchange(other.table_, nullptr)), caller_(std::move(other.caller_)) {}

Connections::Call& Connections::Call::operator=(Call&& other) noexcept {
  if (this != &other) {
    leave();
    table_ = std::exchange(other.table_, nullptr);
    caller_ = std::move(other.caller_);
  }
  return *this;
}

void Connections::Call::identify(const Identity& identity) {
  caller_.identity = identity;
  if (identity.token != 0) caller_.peer = "owner:" + identity.owner;
}

void Connections::Call::leave() {
  if (table_ != nullptr) std::exchange(table_, nullptr)->end_call(caller_.connection);
}

std::optional<std::uint64_t> Connections::admit(const PeerIdentity& identity,
                                                const std::weak_ptr<Line>& line) {
  Lines going;  // the last hold on one of them may be ours, and its end comes back to this table
  const base::MutexLock lock(mutex_);
  if (!has_room(identity, going)) return std::nullopt;
  const std::uint64_t number = next_number_++;
  Entry& entry = entries_[number];
  entry.identity = identity;
  entry.line = line;
  entry.idle_since = options_.now();
  return number;
}

void Connections::hand_over(std::uint64_t connection, int socket, bool has_certificate) {
  const base::MutexLock lock(mutex_);
  const auto found = entries_.find(connection);
  if (found == entries_.end()) return;
  found->second.socket = socket;
  found->second.has_certificate = has_certificate;
  by_socket_[socket] = connection;
}

void Connections::forget(std::uint64_t connection) {
  const base::MutexLock lock(mutex_);
  const auto found = entries_.find(connection);
  if (found == entries_.end()) return;
  const Entry& gone = found->second;
  if (gone.for_client && !gone.for_worker) --clients_;
  // gRPC may have closed its socket before, whose number is another's by now.
  const auto named = by_socket_.find(gone.socket);
  if (named != by_socket_.end() && named->second == connection) by_socket_.erase(named);
  entries_.erase(found);
}

Connections::Entries::iterator Connections::find(const std::string& peer) {
  const auto named = by_socket_.find(descriptor_of(peer));
  return named == by_socket_.end() ? entries_.end() : entries_.find(named->second);
}

bool Connections::has_room(const PeerIdentity& identity, Lines& going) {
  const std::size_t share = std::max<std::size_t>(1, options_.most - options_.most / 4);
  const auto same = [&](const auto& entry) { return entry.second.identity.name == identity.name; };
  const auto own = static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(), same));
  if (own >= share && own < entries_.size() && !close_idle(&identity.name, going)) return false;
  if (entries_.size() < options_.most) return true;
  // The one that goes makes room in a moment.
  return entries_.size() < options_.most + options_.spare && close_idle(nullptr, going);
}

/// Tells the idlest connection, of this peer or of all, to close.
bool Connections::close_idle(const std::string* of_peer, Lines& going) {
  const Time newest = options_.now() - options_.grace;
  auto found = entries_.end();
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    const Entry& candidate = entry->second;
    if (candidate.calls > 0 || candidate.closing || candidate.idle_since > newest) continue;
    if (of_peer != nullptr && candidate.identity.name != *of_peer) continue;
    const auto rank = [](const Entry& one) { return std::make_pair(one.used, one.idle_since); };
    if (found == entries_.end() || rank(candidate) < rank(found->second)) found = entry;
  }
  if (found == entries_.end()) return false;
  found->second.closing = true;
  if (auto line = found->second.line.lock()) {
    line->hang_up();
    going.push_back(std::move(line));
  }
  return true;
}

Connections::Call Connections::begin(const std::string& peer, Side side) {
  const base::MutexLock lock(mutex_);
  const auto found = find(peer);
  if (found == entries_.end()) return {nullptr, {number_of_stranger(peer), peer}};
  Entry& entry = found->second;
  const bool was_client = entry.for_client && !entry.for_worker;
  if (side == Side::kClient && !entry.for_client && !entry.for_worker) {
    if (clients_ + options_.for_workers >= options_.most) {
      throw CallEnded({grpc::StatusCode::UNAVAILABLE,
                       std::to_string(clients_) +
                           " clients are connected, the most that this server has at once; try again"});
    }
  }
  (side == Side::kClient ? entry.for_client : entry.for_worker) = true;
  const bool is_client = entry.for_client && !entry.for_worker;
  clients_ += static_cast<std::size_t>(is_client);
  clients_ -= static_cast<std::size_t>(was_client);
  entry.used = true;
  ++entry.calls;
  return {this, {found->first, entry.identity.name, entry.identity.uid, entry.has_certificate, {}}};
}

void Connections::end_call(std::uint64_t connection) {
  const base::MutexLock lock(mutex_);
  const auto found = entries_.find(connection);
  if (found == entries_.end()) return;
  if (--found->second.calls == 0) found->second.idle_since = options_.now();
}

std::optional<std::uint64_t> Connections::answered(std::uint64_t connection) const {
  std::shared_ptr<Line> line;  // see admit()
  const base::MutexLock lock(mutex_);
  const auto found = entries_.find(connection);
  if (found == entries_.end()) return std::nullopt;
  line = found->second.line.lock();
  return line == nullptr ? std::nullopt : std::optional(line->answered());
}

std::size_t Connections::calls() const {
  const base::MutexLock lock(mutex_);
  std::size_t sum = 0;
  for (const auto& [number, entry] : entries_) sum += entry.calls;
  return sum;
}

std::size_t Connections::size() const {
  const base::MutexLock lock(mutex_);
  return entries_.size();
}

}  // namespace affskel::server
