#include "scheduling/worker_registry.h"

#include <algorithm>
#include <utility>

#include "base/mutex.h"

#include "wire/identity.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

constexpr std::int64_t kForgetMs = 60000;

// Bounds the list: anybody can make up ids.
constexpr std::size_t kMaxKnownWorkers = 4096;

}  // namespace

void WorkerRegistry::add_supervised(std::uint32_t pid) {
  const base::MutexLock lock(mutex_);
  supervised_.insert(pid);
}

void WorkerRegistry::remove_supervised(std::uint32_t pid) {
  const base::MutexLock lock(mutex_);
  supervised_.erase(pid);
  std::erase_if(workers_, [pid](const auto& entry) {
    return entry.second.info.supervised() && entry.second.info.pid() == pid;
  });
}

bool WorkerRegistry::is_supervised(const v1::WorkerIdentity& worker) const {
  const base::MutexLock lock(mutex_);
  return supervised_.contains(worker.pid()) && worker.host() == wire::host_name();
}

void WorkerRegistry::seen(const v1::WorkerIdentity& worker, std::uint32_t wait_ms) {
  const bool supervised = is_supervised(worker);
  const base::MutexLock lock(mutex_);
  if (workers_.size() >= kMaxKnownWorkers && !workers_.contains(worker.id())) forget_one();
  Entry& entry = workers_[worker.id()];
  entry.wait_ms = wait_ms;
  v1::WorkerInfo& info = entry.info;
  info.set_id(worker.id());
  info.set_host(worker.host());
  info.set_pid(worker.pid());
  info.set_threads(worker.threads());
  info.set_core_version(worker.core_version());
  info.set_supervised(supervised);
  info.set_memory(worker.memory());
  hear(entry);
  forget_silent();
}

void WorkerRegistry::granted(const v1::WorkerIdentity& worker, const v1::Lease& lease) {
  const base::MutexLock lock(mutex_);
  const auto found = workers_.find(worker.id());
  if (found == workers_.end()) return;
  found->second.wait_ms = 0;
  hear(found->second);
  found->second.tasks[lease.token()] = wire::word(lease.kind()) + " " + lease.job().id();
  holders_[lease.token()] = worker.id();
}

void WorkerRegistry::used(const std::string& token) {
  const base::MutexLock lock(mutex_);
  const auto holder = holders_.find(token);
  if (holder == holders_.end()) return;
  const auto found = workers_.find(holder->second);
  if (found == workers_.end()) return;
  found->second.wait_ms = 0;
  hear(found->second);
}

void WorkerRegistry::ended(const std::string& token) {
  const base::MutexLock lock(mutex_);
  const auto holder = holders_.find(token);
  if (holder == holders_.end()) return;
  if (const auto found = workers_.find(holder->second); found != workers_.end())
    found->second.tasks.erase(token);
  holders_.erase(holder);
}

void WorkerRegistry::hear(Entry& entry) const {
  entry.heard_ms = clock_.lease_ms();
  entry.info.set_last_seen_ms(static_cast<std::uint64_t>(clock_.wall_ms()));
}

void WorkerRegistry::forget_silent() {
  std::erase_if(workers_, [this](const auto& entry) { return entry.second.heard_ms < oldest_ms(); });
  std::erase_if(holders_, [this](const auto& holder) {
    mutex_.assert_held();
    return !workers_.contains(holder.second);
  });
}

/// The one not heard from for longest, of those that work on nothing if there are such.
void WorkerRegistry::forget_one() {
  const auto rank = [](const auto& entry) {
    return std::make_pair(!entry.second.tasks.empty(), entry.second.info.last_seen_ms());
  };
  workers_.erase(std::min_element(workers_.begin(), workers_.end(),
                                  [&](const auto& a, const auto& b) { return rank(a) < rank(b); }));
}

bool WorkerRegistry::is_silent(const Entry& entry) const {
  return clock_.lease_ms() - entry.heard_ms > entry.wait_ms + silence_ms_;
}

std::int64_t WorkerRegistry::oldest_ms() const {
  return clock_.lease_ms() - kForgetMs;
}

std::vector<WorkerRegistry::Present> WorkerRegistry::present() const {
  const base::MutexLock lock(mutex_);
  std::vector<Present> present;
  for (const auto& [id, entry] : workers_) {
    if (!is_silent(entry)) present.push_back({entry.info.memory(), !entry.tasks.empty()});
  }
  return present;
}

std::vector<v1::WorkerInfo> WorkerRegistry::list() const {
  const base::MutexLock lock(mutex_);
  std::vector<v1::WorkerInfo> infos;
  for (const auto& [id, entry] : workers_) {
    if (entry.heard_ms < oldest_ms()) continue;
    infos.push_back(entry.info);
    infos.back().set_silent(is_silent(entry));
    if (!entry.tasks.empty() && !infos.back().silent()) infos.back().set_task(entry.tasks.rbegin()->second);
  }
  return infos;
}

}  // namespace affskel::server
