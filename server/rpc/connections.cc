#include "rpc/connections.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "base/mutex.h"
#include "rpc/status.h"

namespace affskel::server {
namespace {

/// Names what a descriptor is open for: another number once that was closed.  0 = nothing.
std::uint64_t inode_of(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 && S_ISSOCK(status.st_mode) ? status.st_ino : 0;
}

/// -1 for a peer that is not named by its descriptor.
int descriptor_of(std::string_view peer) {
  constexpr std::string_view kPrefix = "fd:";
  int fd = -1;
  if (peer.starts_with(kPrefix)) std::from_chars(peer.data() + kPrefix.size(), peer.data() + peer.size(), fd);
  return fd;
}

/// Connections that gRPC names otherwise have numbers of their own, beyond those of the table.
std::uint64_t number_of_stranger(const std::string& peer) {
  return std::hash<std::string>{}(peer) | (std::uint64_t{1} << 63);
}

}  // namespace

PeerIdentity peer_of(int fd) {
  sockaddr_storage name{};
  socklen_t size = sizeof name;
  if (getpeername(fd, reinterpret_cast<sockaddr*>(&name), &size) != 0) return {"gone", {}, {}};
  if (name.ss_family == AF_UNIX) {
    ucred credentials{};
    socklen_t length = sizeof credentials;
    if (getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &credentials, &length) != 0) return {"uid:unknown", {}, {}};
    return {"uid:" + std::to_string(credentials.uid), credentials.uid, {}};
  }
  char text[INET6_ADDRSTRLEN] = "unknown";
  if (name.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(name);
    inet_ntop(AF_INET, &v4.sin_addr, text, sizeof text);
    return {std::string("ip:") + text,
            {},
            std::string("ipv4:") + text + ":" + std::to_string(ntohs(v4.sin_port))};
  }
  if (name.ss_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(name);
    inet_ntop(AF_INET6, &v6.sin6_addr, text, sizeof text);
    // gRPC writes names as URIs, in which brackets are percent-encoded.
    return {std::string("ip:") + text,
            {},
            std::string("ipv6:%5B") + text + "%5D:" + std::to_string(ntohs(v6.sin6_port))};
  }
  return {std::string("ip:") + text, {}, {}};
}

Connections::Use::Use(Use&& other) noexcept
    : table_(std::exchange(other.table_, nullptr)), caller_(std::move(other.caller_)) {}

Connections::Use& Connections::Use::operator=(Use&& other) noexcept {
  if (this != &other) {
    leave();
    table_ = std::exchange(other.table_, nullptr);
    caller_ = std::move(other.caller_);
  }
  return *this;
}

void Connections::Use::identify(const Identity& identity) {
  caller_.identity = identity;
  if (identity.token != 0) caller_.peer = "owner:" + identity.owner;
}

void Connections::Use::leave() {
  if (table_ != nullptr) std::exchange(table_, nullptr)->end_use(caller_.connection);
}

bool Connections::admit(int fd, const PeerIdentity& identity) {
  const base::MutexLock lock(mutex_);
  if (const auto before = entries_.find(fd); before != entries_.end()) {
    forget(before);  // gRPC has closed it, or the number would not have been given out again
  }
  if (!has_room(fd, identity)) return false;
  const std::uint64_t number = next_number_++;
  Entry entry;
  entry.number = number;
  entry.inode = inode_of(fd);
  entry.identity = identity;
  entry.idle_since = options_.now();
  entries_.emplace(fd, std::move(entry));
  by_number_.emplace(number, fd);
  if (!identity.socket_name.empty()) by_socket_name_[identity.socket_name] = fd;
  return true;
}

Connections::Entries::iterator Connections::find(const std::string& peer) {
  if (const int fd = descriptor_of(peer); fd >= 0) return entries_.find(fd);
  const auto named = by_socket_name_.find(peer);
  return named == by_socket_name_.end() ? entries_.end() : entries_.find(named->second);
}

/// Returns the entry after it.
Connections::Entries::iterator Connections::forget(Entries::iterator entry) {
  const Entry& gone = entry->second;
  if (gone.for_client && !gone.for_worker) --clients_;
  by_number_.erase(gone.number);
  const auto named = by_socket_name_.find(gone.identity.socket_name);
  if (named != by_socket_name_.end() && named->second == entry->first) by_socket_name_.erase(named);
  return entries_.erase(entry);
}

bool Connections::has_room(int fd, const PeerIdentity& identity) {
  const std::size_t share = std::max<std::size_t>(1, options_.most - options_.most / 4);
  if (entries_.size() >= share) sweep_locked();
  const auto same = [&](const auto& entry) { return entry.second.identity.name == identity.name; };
  const auto own = static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(), same));
  if (own >= share && own < entries_.size() && !close_idle(&identity.name)) return false;
  if (fd < options_.first_refused) return true;
  // The one that goes sets its number free in a moment.
  return close_idle(nullptr) && fd < options_.first_refused + options_.spare;
}

/// Tells the idlest connection, of this peer or of all, to close.
bool Connections::close_idle(const std::string* of_peer) {
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
  // Only the thread that calls admit() opens sockets, so that this is still the one that was meant.
  if (inode_of(found->first) == found->second.inode) shutdown(found->first, SHUT_RDWR);
  return true;
}

Connections::Use Connections::begin(const std::string& peer, Side side) {
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
  return {this, {entry.number, entry.identity.name, entry.identity.uid, {}}};
}

void Connections::end_use(std::uint64_t connection) {
  const base::MutexLock lock(mutex_);
  const auto number = by_number_.find(connection);
  if (number == by_number_.end()) return;
  Entry& entry = entries_.at(number->second);
  if (--entry.calls == 0) entry.idle_since = options_.now();
}

void Connections::sweep() {
  const base::MutexLock lock(mutex_);
  sweep_locked();
}

void Connections::sweep_locked() {
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    entry = inode_of(entry->first) != entry->second.inode ? forget(entry) : std::next(entry);
  }
}

std::size_t Connections::calls() const {
  const base::MutexLock lock(mutex_);
  std::size_t sum = 0;
  for (const auto& [fd, entry] : entries_) sum += entry.calls;
  return sum;
}

std::size_t Connections::size() const {
  const base::MutexLock lock(mutex_);
  return entries_.size();
}

}  // namespace affskel::server
